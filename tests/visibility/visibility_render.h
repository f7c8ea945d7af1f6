#pragma once
// Rendering small scenes with the methods vpl_*.

#include "gi/hit_buffers/settings.h"
#include "gi/methods/reference/reference.h"
#include "gi/methods/vpl/settings.h"
#include "gi/methods/vpl/visibility.h"
#include "tests/support/scenes.h"
#include "tests/support/statistics.h"

#include <gtest/gtest.h>

namespace gi::test {

inline constexpr VisibilityKind kKinds[] = {VisibilityKind::exact,       VisibilityKind::slhb,
                                            VisibilityKind::imperfect,   VisibilityKind::ambient,
                                            VisibilityKind::directional, VisibilityKind::none};

inline RenderSettings small_picture(int size, std::uint32_t paths, int bounces)
{
    RenderSettings s;
    s.width = s.height = size;
    s.paths = paths;
    s.bounces = bounces;
    s.seed = 5;
    s.of<SlhbSettings>().directions = "icosahedron:80"; // quick to build
    s.of<SlhbSettings>().resolution = 32;
    s.of<VirtualLightSettings>().light_paths = 64;
    return s;
}

struct VisibilityRun {
    RenderResult result;
    std::map<std::string, Report::Loss> losses;
    std::map<std::string, double> counts;
};

inline VisibilityRun render_visibility(VisibilityKind kind, World const& world, Camera const& camera,
                                       RenderSettings const& settings)
{
    StopRequest stop;
    Report report;
    VisibilityRun run{render_with_virtual_lights(kind, world, camera, settings, stop, {}, report), {}, {}};
    run.losses = report.losses();
    run.counts = report.counts();
    EXPECT_EQ(run.losses.count("path terms that were not finite, dropped"), 0u);
    for (Layer const& layer : run.result.picture.layers)
        for (float const v : layer.data) EXPECT_TRUE(std::isfinite(v)) << layer.name;
    return run;
}

inline Picture reference_picture(World const& world, Camera const& camera, RenderSettings const& settings)
{
    StopRequest stop;
    Report report;
    return render_reference(world, camera, settings, stop, {}, report).picture;
}

/// Mean over renders with different seeds, since all pixels of one share virtual lights.
inline RunningMean mean_over_seeds(VisibilityKind kind, World const& world, Camera const& camera,
                                   RenderSettings settings, int seeds, std::string const& layer = "color")
{
    RunningMean mean;
    for (int k = 0; k < seeds; ++k) {
        settings.seed = std::uint64_t(k) + 1;
        mean.add(mean_of(render_visibility(kind, world, camera, settings).result.picture, layer).mean);
    }
    return mean;
}

inline RunningMean reference_over_seeds(World const& world, Camera const& camera, RenderSettings settings,
                                        int seeds, std::string const& layer = "color")
{
    RunningMean mean;
    for (int k = 0; k < seeds; ++k) {
        settings.seed = std::uint64_t(k) + 101;
        mean.add(mean_of(reference_picture(world, camera, settings), layer).mean);
    }
    return mean;
}

/// A closed grey box with a block on its floor and a lamp under its ceiling; the block hides much of the floor.
inline Scene box_with_block()
{
    Scene scene;
    add_box(scene, {-1, -1, -1}, {1, 1, 1}, add_material(scene, lambert(vec3{0.6f})), true);
    add_box(scene, {-0.4f, -1, -0.4f}, {0.3f, 0, 0.2f}, add_material(scene, lambert(vec3{0.4f, 0.6f, 0.2f})),
            false);
    add_quad(scene, {-0.3f, 0.99f, -0.3f}, {0.6f, 0, 0}, {0, 0, 0.6f}, add_material(scene, emitter(vec3{10})));
    return scene;
}

inline Camera in_the_box() { return look_at({0.8, 0.5, 0.9}, {-0.1, -0.6, -0.2}, 60); }

} // namespace gi::test
