// How much of the time of the reference path tracer is not Embree: the same rays, traced by the path tracer,
// replayed in a bare loop of single rays, and replayed in the path tracer's packets; by turns in one process on
// one thread. Prints medians over the rounds and their ratios.
//   bench_path_throughput [SCENE...]      default: boxes of 1M triangles, atrium, cornell

#include "gi/core/quantile.h"
#include "gi/core/report.h"
#include "gi/methods/reference/embree_paths.h"
#include "gi/scene/generate/generate.h"
#include "gi/scene/load/load.h"
#include "gi/scene/model/plan.h"

#include <algorithm>
#include <chrono>
#include <fmt/format.h>
#include <numeric>

namespace {

using namespace gi;

/// Rays of one kind that were asked for together.
struct Wave {
    std::vector<RayQuery> queries;
    bool shadow;
};

struct RecordingVisibility {
    ExactVisibility const& exact;
    std::vector<Wave>& waves;

    void nearest(std::span<RayQuery const> queries, std::span<Hit> hits) const
    {
        waves.push_back({{queries.begin(), queries.end()}, false});
        exact.nearest(queries, hits);
    }
    void transmittance(std::span<RayQuery const> queries, std::span<vec3> left) const
    {
        waves.push_back({{queries.begin(), queries.end()}, true});
        exact.transmittance(queries, left);
    }
};

template <class Visibility>
double trace_all(PathTracer<Visibility> const& tracer, int size, std::uint32_t paths)
{
    PathCounts counts;
    double sum = 0;
    std::vector<Path> batch;
    for (int top = 0; top < size; top += TiledPass::kTile)
        for (int left = 0; left < size; left += TiledPass::kTile)
            for (std::uint32_t i = 0; i < paths; ++i) {
                batch.clear();
                for (int y = top; y < top + TiledPass::kTile; ++y)
                    for (int x = left; x < left + TiledPass::kTile; ++x)
                        batch.push_back(tracer.steps.start(x, y, i));
                tracer.trace(batch, counts);
                for (Path const& p : batch)
                    sum += double(p.sample.radiance[0].x + p.sample.radiance[1].x + p.sample.radiance[2].x);
            }
    return sum;
}

/// One ray after the other, as a renderer without packets would ask.
std::uint64_t replay(ExactVisibility const& exact, std::vector<Wave> const& waves)
{
    std::uint64_t hits = 0;
    ExactVisibility::Context context(exact);
    for (Wave const& wave : waves)
        for (RayQuery const& q : wave.queries) {
            RTCRayHit r;
            r.ray.org_x = q.ray.origin.x;
            r.ray.org_y = q.ray.origin.y;
            r.ray.org_z = q.ray.origin.z;
            r.ray.tnear = 0;
            r.ray.dir_x = q.ray.direction.x;
            r.ray.dir_y = q.ray.direction.y;
            r.ray.dir_z = q.ray.direction.z;
            r.ray.time = 0;
            r.ray.tfar = q.reach;
            r.ray.mask = 0xffffffffu;
            r.ray.id = q.seed;
            r.ray.flags = 0;
            r.hit.geomID = RTC_INVALID_GEOMETRY_ID;
            if (wave.shadow)
                embree::occluded(exact.scene(), context.rtc, r.ray);
            else
                embree::intersect(exact.scene(), context.rtc, r);
            hits += wave.shadow ? r.ray.tfar < 0 : r.hit.geomID != RTC_INVALID_GEOMETRY_ID;
        }
    return hits;
}

/// In the packets that the path tracer uses.
std::uint64_t replay_packets(ExactVisibility const& exact, std::vector<Wave> const& waves)
{
    std::uint64_t hits = 0;
    std::vector<Hit> hit;
    std::vector<std::uint8_t> blocked;
    for (Wave const& wave : waves) {
        hit.resize(wave.queries.size());
        blocked.resize(wave.queries.size());
        if (wave.shadow) {
            exact.occluded(wave.queries, blocked);
            hits += std::accumulate(blocked.begin(), blocked.end(), std::uint64_t(0));
        } else {
            exact.nearest(wave.queries, hit);
            hits +=
                std::uint64_t(std::ranges::count_if(hit, [](Hit const& h) { return h.triangle != kNoTriangle; }));
        }
    }
    return hits;
}

template <class Work>
double seconds(Work const& work)
{
    auto const start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void measure(std::string const& name, Scene scene)
{
    constexpr int kSize = 96, kRounds = 15;
    constexpr std::uint32_t kPaths = 8;
    Report report;
    World const world = build_world(std::make_shared<Scene const>(std::move(scene)), std::nullopt, report);
    ExactVisibility const exact(world, plan_scene(world).alpha_tests, 1);
    if (world.cameras.empty()) throw std::runtime_error(name + " has no camera");
    CameraRays const camera = camera_rays(world.cameras[0], kSize, kSize, world.origin);

    PathSteps const steps{view(world), camera, 64, 0, PixelFilter::box, kSize};
    std::vector<Wave> waves;
    RecordingVisibility const recorder{exact, waves};
    double const expected = trace_all(PathTracer<RecordingVisibility>{steps, recorder}, kSize, kPaths);
    PathTracer<ExactVisibility> const tracer{steps, exact};
    double n = 0;
    for (Wave const& w : waves) n += double(w.queries.size());

    std::vector<double> traced, single, packets, to_single, to_packets;
    std::uint64_t hits = 0, packet_hits = 0;
    for (int round = 0; round < kRounds; ++round) {
        double sum = 0;
        traced.push_back(seconds([&] { sum = trace_all(tracer, kSize, kPaths); }));
        // The compiler may round differently when it records; more than that would be other rays.
        if (std::abs(sum - expected) > 1e-4 * expected) throw std::runtime_error("the two traces differ");
        single.push_back(seconds([&] { hits += replay(exact, waves); }));
        packets.push_back(seconds([&] { packet_hits += replay_packets(exact, waves); }));
        to_single.push_back(traced.back() / single.back());
        to_packets.push_back(traced.back() / packets.back());
    }
    auto const mega_per_s = [&](std::vector<double> const& s) { return n / median(s) * 1e-6; };
    auto const [low, high] = std::minmax_element(to_single.begin(), to_single.end());
    fmt::print("{:<28} {:>9} {:>9.0f} {:>8.3f} {:>8.3f} {:>8.3f} {:>7.3f} [{:.3f}, {:.3f}] {:>8.3f} {:>7.0f}\n",
               name, world.triangles.size(), n, mega_per_s(traced), mega_per_s(single), mega_per_s(packets),
               median(to_single), *low, *high, median(to_packets), (median(traced) - median(packets)) / n * 1e9);
    if (double(hits) != double(packet_hits))
        fmt::print("  {} hits by single rays, {} in packets\n", hits, packet_hits);
}

} // namespace

int main(int argc, char** argv)
{
    fmt::print("{:<48} {:^26} {:^31} {:>7}\n", "", "Mray/s", "time of the paths over", "shading");
    fmt::print("{:<28} {:>9} {:>9} {:>8} {:>8} {:>8} {:>7} {:^14} {:>8} {:>7}\n", "scene", "triangles", "rays",
               "paths", "single", "packets", "single", "[min, max]", "packets", "ns/ray");
    if (argc == 1) {
        measure("boxes, 1M triangles", generate_boxes(1'000'000, 0));
        measure("atrium", generate_atrium({}));
        measure("cornell", generate_cornell());
    }
    for (int i = 1; i < argc; ++i) {
        Report report;
        measure(argv[i], load_scene(argv[i], report));
    }
}
