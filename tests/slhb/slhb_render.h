#pragma once
// Rendering small scenes with the method whose options a test sets: slhb with any of hit buffers, paths_shadow_maps with
// any of shadow maps alone, else paths.

#include "gi/hit_buffers/options.h"
#include "gi/methods/paths/choose.h"
#include "gi/methods/paths/paths.h"
#include "gi/methods/slhb/slhb.h"
#include "tests/support/scenes.h"

#include <gtest/gtest.h>

namespace gi::test {

struct SlhbRun {
    RenderResult result;
    std::map<std::string, Report::Loss> losses;
    std::map<std::string, double> counts;
};

inline RenderSettings small_settings(int size, std::uint32_t paths, int bounces)
{
    RenderSettings s;
    s.width = s.height = size;
    s.paths = paths;
    s.bounces = bounces;
    s.seed = 5;
    return s;
}

inline PathAlgorithm algorithm_as_set(RenderSettings const& s)
{
    bool look_ups = s.of<SlhbSettings>().exact.any(), maps = look_ups;
    for (RenderOption const& o : hit_buffer_options())
        if (o.name != "memory" && o.get(s) != o.get({})) (o.group == "Shadow maps" ? maps : look_ups) = true;
    return {look_ups ? SurfacesBy::look_ups : SurfacesBy::rays, look_ups || maps ? ShadowsBy::maps : ShadowsBy::rays};
}
inline RenderResult render_as_set(World const& world, Camera const& camera, RenderSettings const& s,
                                  StopRequest const& stop, RenderProgress const& progress, Report& report)
{
    return render_by("test", world, camera, with(algorithm_as_set(s), s), stop, progress, report);
}
inline std::unique_ptr<FrameRenderer> start_frames_as_set(MovingWorld const& world, Camera const& camera,
                                                          RenderSettings const& s, Report& report)
{
    return start_frames_by(world, camera, with(algorithm_as_set(s), s), report);
}

inline SlhbRun render_small(World const& world, Camera const& camera, RenderSettings const& settings)
{
    StopRequest stop;
    Report report;
    SlhbRun run{render_as_set(world, camera, settings, stop, {}, report), {}, {}};
    run.losses = report.losses();
    run.counts = report.counts();
    EXPECT_EQ(run.losses.count("path terms that were not finite, dropped"), 0u);
    for (Layer const& layer : run.result.picture.layers)
        for (float const v : layer.data) EXPECT_TRUE(std::isfinite(v)) << layer.name;
    return run;
}

/// A closed grey box with a coloured block on its floor and a lamp under its ceiling.
inline Scene box_with_block_and_lamp()
{
    Scene scene;
    add_box(scene, {-1, -1, -1}, {1, 1, 1}, add_material(scene, lambert(vec3{0.6f})), true);
    add_box(scene, {-0.4f, -1, -0.4f}, {0.3f, 0, 0.2f}, add_material(scene, lambert(vec3{0.4f, 0.6f, 0.2f})),
            false);
    add_quad(scene, {-0.3f, 0.99f, -0.3f}, {0.6f, 0, 0}, {0, 0, 0.6f}, add_material(scene, emitter(vec3{10})));
    return scene;
}

/// A room of 4 m with an open side, on a plane of `reach` m to each side, under a sky.
inline Scene room_on_a_plane(float reach)
{
    Scene scene;
    int const wall = add_material(scene, lambert(vec3{0.6f}));
    add_quad(scene, {-reach, -0.01f, reach}, {2 * reach, 0, 0}, {0, 0, -2 * reach}, wall);
    add_quad(scene, {-2, 0, 2}, {4, 0, 0}, {0, 0, -4}, wall); // floor
    add_quad(scene, {-2, 3, -2}, {4, 0, 0}, {0, 0, 4}, wall); // ceiling
    add_quad(scene, {-2, 0, -2}, {4, 0, 0}, {0, 3, 0}, wall); // back
    add_quad(scene, {-2, 0, 2}, {0, 0, -4}, {0, 3, 0}, wall); // left
    add_quad(scene, {2, 0, -2}, {0, 0, 4}, {0, 3, 0}, wall);  // right
    add_box(scene, {-0.5f, 0, -0.5f}, {0.5f, 1, 0.5f}, wall, false);
    set_environment(scene, vec3{1});
    return scene;
}
/// Boxes of 8 m on a plane of 10 km: between texel centres, so that no column has them, and all agree about what lies beyond.
inline Scene village()
{
    Scene scene;
    int const ground = add_material(scene, lambert(vec3{0.5f}));
    add_quad(scene, {-5000, 0, 5000}, {10000, 0, 0}, {0, 0, -10000}, ground);
    for (int k = 0; k < 25; ++k) {
        vec3 const at{float(k % 5) * 30 - 60, 0, float(k / 5) * -30};
        add_box(scene, at, at + vec3{8, 6, 8}, ground, false);
    }
    set_environment(scene, vec3{1});
    return scene;
}

inline Camera const kInRoom = look_at({0.5, 1.6, 1.5}, {-0.3, 0.8, -1}, 70);

} // namespace gi::test
