// Bias of slhb against the reference under real panoramas, on a diffuse and a glossy object.

#include "gi/hit_buffers/settings.h"
#include "gi/methods/reference/reference.h"
#include "gi/scene/load/load.h"
#include "tests/slhb/slhb_render.h"
#include "tests/support/data.h"
#include "tests/support/statistics.h"

#include <fmt/format.h>

namespace gi::test {
namespace {

/// A ball on a floor.
World ball_on_floor(EnvironmentMap const& map, bool glossy)
{
    Scene scene;
    Material ball = lambert({0.7f, 0.5f, 0.3f});
    if (glossy) {
        ball.specular = 1;
        ball.roughness = 0.3f; // narrow: its lobe goes along exact rays
    }
    add_quad(scene, {-3, 0, 3}, {6, 0, 0}, {0, 0, -6}, add_material(scene, lambert(vec3{0.5f})));
    add_sphere(scene, {0, 0.8f, 0}, 0.8f, 4, add_material(scene, ball), true);
    scene.environment = map;
    return world_of(std::move(scene));
}

/// Means over seeds of all light from surfaces.
template <class Render>
RunningMean over_seeds(int seeds, RenderSettings s, Render const& render)
{
    RunningMean mean;
    for (int k = 0; k < seeds; ++k) {
        s.seed = std::uint64_t(40 + k);
        Picture const p = render(s);
        mean.add(mean_of(p, "L1").mean + mean_of(p, "L2").mean);
    }
    return mean;
}

struct Sky {
    char const* file;
    int stored_seeds; ///< errors of a stored set are the same in all passes, so many sets are averaged
};

class RealSky : public testing::TestWithParam<Sky> {};

TEST_P(RealSky, NoBiasAgainstTheReference)
{
    auto const& [file, stored_seeds] = GetParam();
    LIGHTWELL_NEED_DATA(std::string("envmaps/") + file);
    Report report;
    EnvironmentMap const map = load_environment(shared_data() / "envmaps" / file, report);
    Camera const camera = look_at({1.5, 1.6, 3.2}, {0, 0.6, 0}, 35);
    for (bool const glossy : {false, true}) {
        World const world = ball_on_floor(map, glossy);
        RunningMean const truth = over_seeds(6, small_settings(40, 1024, 3), [&](RenderSettings const& s) {
            StopRequest stop;
            Report lost;
            return render_reference(world, camera, s, stop, {}, lost).picture;
        });
        for (Schedule const schedule : {Schedule::streamed, Schedule::stored}) {
            bool const stored = schedule == Schedule::stored;
            RenderSettings s = small_settings(40, stored ? 48 : 256, 3);
            s.of<SlhbSettings>().schedule = schedule;
            s.of<SlhbSettings>().resolution = 128;
            s.of<SlhbSettings>().shadow_resolution = 512;
            s.of<SlhbSettings>().light_samples = 8;
            s.of<SlhbSettings>().axes = 8;
            RunningMean const found = over_seeds(stored ? stored_seeds : 6, s, [&](RenderSettings const& now) {
                return render_small(world, camera, now).result.picture;
            });
            double const sigma = std::hypot(truth.sigma(), found.sigma()), bias = found.mean() - truth.mean();
            fmt::print("{} {} {}: bias {:+.3f} % +- {:.3f}, z {:+.2f}\n", file, glossy ? "glossy" : "diffuse",
                       stored ? "stored" : "streamed", 100 * bias / truth.mean(), 100 * sigma / truth.mean(),
                       bias / sigma);
            EXPECT_LT(sigma, 0.0025 * truth.mean()); // else the next line says nothing
            EXPECT_LT(std::abs(bias), 0.005 * truth.mean());
        }
    }
}

// Indoors, where light comes from few lamps, it takes more of them.
INSTANTIATE_TEST_SUITE_P(Of, RealSky,
                         testing::Values(Sky{"kloppenheim_05_1k.hdr", 48}, Sky{"dresden_square_1k.hdr", 48},
                                         Sky{"autoshop_01_1k.hdr", 96}),
                         [](auto const& map) {
                             std::string const name = map.param.file;
                             return name.substr(0, name.find('_'));
                         });

} // namespace
} // namespace gi::test
