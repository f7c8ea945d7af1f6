// Surfaces are drawn again only when a moment looks different.

#include "viewer/app/pose_at.h"

#include <gtest/gtest.h>

namespace viewer {
namespace {

FrameCommand moment()
{
    FrameCommand m;
    m.views.push_back({"window", {}, 64, 48, -1});
    return m;
}

TEST(LookSame, TimeAloneChangesNothingWhereNothingCanMove)
{
    LiveFrame const frame;
    FrameCommand later = moment();
    later.scene_s = 2;
    later.pose_s = 1;
    EXPECT_TRUE(look_same(frame, moment(), later));
}

TEST(LookSame, CamerasEditsAndNavigationDo)
{
    LiveFrame const frame;
    FrameCommand turned = moment(), edited = moment(), navigated = moment();
    turned.views[0].camera.world_from_camera[3].x = 1e-6;
    edited.changes.push_back({"light.0.scale", 0.5});
    navigated.world_from_room[3].y = 1;
    for (FrameCommand const* other : {&turned, &edited, &navigated})
        EXPECT_FALSE(look_same(frame, moment(), *other));
}

TEST(LookSame, ClipsAndBodiesDoWhereSomethingCanMove)
{
    LiveFrame frame;
    auto scene = std::make_shared<gi::ShownScene>();
    auto moving = std::make_shared<gi::ShownScene::MovingParts>();
    moving->instances.resize(1);
    scene->moving = moving;
    frame.result.scene = scene;
    FrameCommand later = moment(), moved = moment();
    later.scene_s = 2;
    moved.tracked.head.emplace();
    EXPECT_TRUE(look_same(frame, moment(), moment()));
    EXPECT_FALSE(look_same(frame, moment(), later));
    EXPECT_FALSE(look_same(frame, moment(), moved));
}

TEST(DrawingPause, OfSoftwareLeavesTimeToTheLightOfEdits)
{
    Change const object{"object.0", {}}, lamp{"light.all.scale", 0};
    EXPECT_EQ(drawing_pause_s({object, lamp}, false, 0.1), 0);
    EXPECT_EQ(drawing_pause_s({}, true, 0.1), 0);
    EXPECT_EQ(drawing_pause_s({object, lamp}, true, 0.1), 0.1);
    EXPECT_EQ(drawing_pause_s({object}, true, 0.1), 0);
    EXPECT_EQ(drawing_pause_s({object}, true, 0.02), 0.02);
    EXPECT_NEAR(drawing_pause_s({object}, true, 0.04), 0.015, 1e-9);
}

} // namespace
} // namespace viewer
