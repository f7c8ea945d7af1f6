// Frames by kernels on the analytic ladder: where everything glows and reflects alike, light is the same
// everywhere, whatever moves.

#include "gi/hit_buffers/settings.h"
#include "gi/scene/motion/animation.h"
#include "gi/methods/paths/kernels/kernel_frames.h"
#include "tests/slhb/slhb_render.h"
#include "tests/support/on_device.h"

#include <glm/gtc/matrix_transform.hpp>

namespace gi::test {
namespace {

/// A ball that fills the picture, under a sky of radiance 1: what it sends is its albedo.
template <Space S>
void check_furnace()
{
    constexpr float kAlbedo = 0.7f;
    constexpr int kFrames = 6;
    Scene scene;
    add_sphere(scene, vec3{0}, 1, 3, add_material(scene, lambert(vec3{kAlbedo})), false);
    scene.nodes.back().driven = true;
    set_environment(scene, vec3{1});
    auto const shared = std::make_shared<Scene const>(std::move(scene));
    Camera const camera = look_at({0, 0, 2.2}, {0, 0, 0}, 30);
    for (Schedule const schedule : {Schedule::stored, Schedule::temporal, Schedule::streamed}) {
        Report report;
        MovingWorld world(shared, 0, report);
        RenderSettings s = small_settings(8, 8, 1);
        s.of<SlhbSettings>().schedule = schedule;
        if (schedule == Schedule::stored) s.of<SlhbSettings>().directions = "icosahedron:80";
        s.of<SlhbSettings>().resolution = s.of<SlhbSettings>().shadow_resolution = 32;
        s.of<SlhbSettings>().light_samples = 4;
        s.of<SlhbSettings>().axes = schedule == Schedule::stored ? 0 : 4;
        auto const frames = start_kernel_frames(S, world, camera, s, report);
        double sum = 0;
        for (int k = 0; k < kFrames; ++k) {
            Pose pose = evaluate_pose(*shared, 0);
            pose.world_from_node.back() =
                glm::rotate(glm::translate(dmat4(1), dvec3{0.03 * k - 0.08, 0.015 * k, 0}), 0.3 * k,
                            dvec3{0.2, 1, 0.1}) *
                pose.world_from_node.back();
            frames->changed(world.advance(pose));
            sum += mean_of(frames->frame(camera, {}, {}).picture).mean;
        }
        EXPECT_NEAR(sum / kFrames, double(kAlbedo), 0.015 * double(kAlbedo)) << int(schedule);
    }
}
LIGHTWELL_TEST_BOTH(KernelFramesFurnace, StaysAFurnaceWhileSomethingMoves, check_furnace);

/// The mean of many frames is the picture of as many paths, by kernels and by the CPU.
template <Space S>
void check_mean()
{
    Report report;
    MovingWorld const world(std::make_shared<Scene const>(box_with_block_and_lamp()), 0, report);
    Camera const camera = look_at({0.8, 0.5, 0.9}, {-0.2, -0.5, -0.3}, 70);
    RenderSettings s = small_settings(24, 8, 3);
    s.of<SlhbSettings>().schedule = Schedule::stored;
    auto const frames = start_kernel_frames(S, world, camera, s, report);
    double sum = 0;
    for (int k = 0; k < 16; ++k) sum += mean_of(frames->frame(camera, {}, {}).picture, "L2").mean;
    s.paths = 128;
    double const truth = mean_of(render_small(world.world(), camera, s).result.picture, "L2").mean;
    EXPECT_NEAR(sum / 16, truth, 0.01 * truth);
}
LIGHTWELL_TEST_BOTH(KernelFramesFurnace, MeanIsThePictureOfAllPaths, check_mean);

} // namespace
} // namespace gi::test
