// The methods vpl_* live: frames follow what moves.

#include "gi/scene/generate/figure.h"
#include "gi/scene/generate/generate.h"
#include "gi/scene/motion/moving_world.h"
#include "tests/visibility/visibility_render.h"

#include <glm/gtc/matrix_transform.hpp>

namespace gi::test {
namespace {

TEST(VisibilityFrames, AStillFrameIsTheRenderOfAsManyPaths)
{
    Report report;
    MovingWorld const world(std::make_shared<Scene const>(box_with_block()), 0, report);
    RenderSettings const s = small_picture(24, 3, 2);
    StopRequest stop;
    for (VisibilityKind const kind : kKinds) {
        auto const frames = start_virtual_light_frames(kind, world, s, report);
        RenderResult const frame = frames->frame(in_the_box(), stop, {}, {});
        Picture const whole = render_visibility(kind, world.world(), in_the_box(), s).result.picture;
        EXPECT_EQ(frame.picture.find("color")->data, whole.find("color")->data) << int(kind);
        RenderResult const next = frames->frame(in_the_box(), stop, {}, {});
        EXPECT_NE(next.picture.find("color")->data, whole.find("color")->data)
            << "paths of its own, " << int(kind);
    }
}

/// Successive frames of a walking figure equal those of renderers started at that moment.
TEST(VisibilityFrames, FollowWhatMoves)
{
    Scene scene = generate_sphere(2000, 0);
    add_figure(scene, glm::translate(dmat4(1), dvec3{2.5, 1.5, 0}), 0.3);
    auto const walk = std::make_shared<Scene const>(std::move(scene));
    RenderSettings const s = small_picture(32, 1, 2);
    StopRequest stop;
    for (VisibilityKind const kind : kKinds) {
        Report report;
        MovingWorld moving(walk, 0, report);
        MovingWorld const anew(walk, 0.5, report);
        Camera const camera = moving.world().cameras.at(0);
        auto const frames = start_virtual_light_frames(kind, moving, s, report);
        auto const fresh = start_virtual_light_frames(kind, anew, s, report);
        Picture last, truth;
        for (double const t : {0.0, 0.3, 0.5}) {
            frames->changed(moving.advance(t));
            last = frames->frame(camera, stop, {}, {}).picture;
            truth = fresh->frame(camera, stop, {}, {}).picture;
        }
        ASSERT_LT(moving.world().static_triangles, moving.world().triangles.size());
        double const a = mean_of(last, "L2").mean, b = mean_of(truth, "L2").mean;
        EXPECT_NEAR(a, b, 0.005 * b) << int(kind);
        EXPECT_NEAR(mean_of(last, "L1").mean, mean_of(truth, "L1").mean, 1e-3) << int(kind);
    }
}

TEST(VisibilityFrames, ViewsShareVirtualLightsAndAreEachWhatOneViewWouldBe)
{
    Report report;
    MovingWorld const world(std::make_shared<Scene const>(box_with_block()), 0, report);
    RenderSettings const s = small_picture(24, 1, 2);
    StopRequest stop;
    Camera const left = in_the_box(), right = look_at({0.7, 0.5, 0.9}, {-0.1, -0.6, -0.2}, 60);
    for (VisibilityKind const kind : kKinds) {
        FrameView const both[] = {{left, 24, 24}, {right, 16, 16, 0}};
        auto const shared =
            start_virtual_light_frames(kind, world, s, report)->views(both, 2, VertexSharing::cached, stop);
        auto const alone = start_virtual_light_frames(kind, world, s, report)
                               ->views({both + 1, 1}, 2, VertexSharing::exact, stop);
        ASSERT_EQ(shared.size(), 2u);
        EXPECT_EQ(shared[1].picture.find("color")->data, alone[0].picture.find("color")->data) << int(kind);
    }
}

} // namespace
} // namespace gi::test
