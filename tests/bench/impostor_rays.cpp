// Distance impostors beside exact rays (Embree): rays that leave surfaces, cosine-distributed, as light paths do
// after their first vertex; on one thread, by turns in one process, in groups of 64.
//   bench_impostor_rays [--rays N] [--count N] [--resolution N] [SCENE...]
//       default: 100,000 rays; 32 impostors of 128 texels along an edge; cornell, atrium
//
// Columns: wrong: share of the rays that exact rays answer otherwise: a surface where there is none or the
// reverse, or another triangle and a distance that is off by more than 2 % of the exact one. error: mean of
// |distance - exact| / exact over rays for which both meet something, %; median of the same. lost, extra: share of
// the rays that meet nothing though there is something, and the reverse. maps: cube maps a ray used. exact: share
// of the rays whose answer is a triangle that the ray does meet.

#include "gi/light_paths/impostor_places.h"
#include "gi/scene/load/load.h"
#include "gi/scene/model/plan.h"
#include "tests/light_paths/impostor_accuracy.h"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cstring>
#include <fmt/format.h>

namespace {

using namespace gi;

template <class Work>
double seconds(Work const& work)
{
    auto const start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

constexpr std::size_t kTogether = 64;

void by_groups(PathRays const& by, std::span<PathQuery> rays, std::span<Hit> hits)
{
    for (std::size_t first = 0; first < rays.size(); first += kTogether) {
        std::size_t const n = std::min(kTogether, rays.size() - first);
        by.nearest(rays.subspan(first, n), hits.subspan(first, n));
    }
}

struct Kind {
    std::string name;
    ImpostorSettings settings;
};

std::vector<Kind> kinds()
{
    std::vector<Kind> all;
    all.push_back({"first guess", {.search = ImpostorSearch::first_guess}});
    all.push_back({"all", {.search = ImpostorSearch::all}});
    all.push_back({"cascaded", {.search = ImpostorSearch::cascaded}});
    all.push_back({"  energy as printed", {.search = ImpostorSearch::cascaded, .skip_texels = 0}});
    all.push_back({"  16 intervals", {.search = ImpostorSearch::cascaded, .intervals = 16}});
    all.push_back({"walk", {}});
    all.push_back({"  one map", {.most_maps = 1}});
    all.push_back({"  four maps", {.most_maps = 4}});
    return all;
}

void measure(std::string const& name, std::size_t n, ImpostorPlacement const& placement, std::uint32_t resolution)
{
    Report report;
    World const world = build_world(std::make_shared<Scene const>(load_scene(name, report)), std::nullopt, report);
    ExactVisibility const visibility(world, plan_scene(world).alpha_tests, 0);
    std::vector<vec3> centres;
    double const place_s = seconds([&] { centres = place_impostors(world, visibility, placement); });
    std::optional<Impostors> impostors;
    double const draw_s = seconds([&] { impostors.emplace(world, centres, resolution); });
    std::vector<PathQuery> rays = test::rays_of_light(world, visibility, n, 3);
    fmt::print(
        "{}: {} triangles, {} impostors of 6 x {}^2 texels ({:.1f} MiB), placed in {:.2f} s, drawn in {:.3f} s; "
        "{} rays\n",
        name, world.triangles.size(), centres.size(), resolution,
        double(impostors->view().texels.size() * sizeof(ImpostorTexel)) / 1048576, place_s, draw_s, rays.size());
    if (rays.empty() || centres.empty()) return;
    ExactPathRays const exact(visibility);
    std::vector<Kind> const all = kinds();
    std::vector<Hit> truth(rays.size()), hits(rays.size());
    constexpr int kRounds = 5;
    std::vector<std::vector<double>> time_s(all.size());
    std::vector<double> exact_s;
    for (int round = 0; round < kRounds; ++round) {
        exact_s.push_back(seconds([&] { by_groups(exact, rays, truth); }));
        for (std::size_t k = 0; k < all.size(); ++k) {
            ImpostorRays const by(world, *impostors, all[k].settings);
            time_s[k].push_back(seconds([&] { by_groups(by, rays, hits); }));
        }
    }
    double const million = double(rays.size()) * 1e-6;
    fmt::print("  {:<22} {:>7} {:>7} {:>7} {:>8} {:>8} {:>6} {:>7} {:>8} {:>8} {:>8}\n", "search", "wrong %",
               "lost %", "extra %", "error %", "median %", "maps", "exact %", "Mray/s", "/ exact", "/ all");
    fmt::print("  {:<22} {:>7} {:>7} {:>7} {:>8} {:>8} {:>6} {:>7} {:>8.3f}\n", "exact rays", "", "", "", "", "",
               "", "", million / median(exact_s));
    for (std::size_t k = 0; k < all.size(); ++k) {
        test::Accuracy const a =
            test::accuracy(truth, test::how_followed(world, *impostors, all[k].settings, rays));
        std::vector<double> by_all, by_exact;
        for (int round = 0; round < kRounds; ++round) {
            by_all.push_back(time_s[1][std::size_t(round)] / time_s[k][std::size_t(round)]);
            by_exact.push_back(exact_s[std::size_t(round)] / time_s[k][std::size_t(round)]);
        }
        fmt::print(
            "  {:<22} {:>7.2f} {:>7.2f} {:>7.2f} {:>8.3f} {:>8.4f} {:>6.2f} {:>7.2f} {:>8.3f} {:>8.3f} {:>8.2f}\n",
            all[k].name, 100 * a.wrong, 100 * a.lost, 100 * a.extra, 100 * a.error, 100 * a.median, a.maps,
            100 * a.exact, million / median(time_s[k]), median(by_exact), median(by_all));
    }
}

} // namespace

int main(int argc, char** argv)
{
    std::size_t rays = 100'000;
    std::uint32_t resolution = 128;
    ImpostorPlacement placement;
    std::vector<std::string> scenes;
    for (int i = 1; i < argc; ++i) {
        auto const number = [&](auto& to) {
            std::from_chars(argv[i + 1], argv[i + 1] + std::strlen(argv[i + 1]), to);
        };
        bool const more = i + 1 < argc;
        if (more && std::strcmp(argv[i], "--rays") == 0)
            number(rays), ++i;
        else if (more && std::strcmp(argv[i], "--count") == 0)
            number(placement.count), ++i;
        else if (more && std::strcmp(argv[i], "--resolution") == 0)
            number(resolution), ++i;
        else
            scenes.emplace_back(argv[i]);
    }
    if (scenes.empty()) scenes = {"cornell", "atrium"};
    for (std::string const& scene : scenes) measure(scene, rays, placement, resolution);
}
