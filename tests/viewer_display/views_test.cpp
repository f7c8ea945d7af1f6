// Eyes of users, views of walls, and what of them is ordered.

#include "tests/viewer_display/display_samples.h"
#include "viewer/displays/view_summary.h"
#include "viewer/displays/views.h"

namespace viewer::test {
namespace {

void expect_near(gi::dvec3 a, gi::dvec3 b)
{
    EXPECT_LT(glm::length(a - b), 1e-12) << a.x << " " << a.y << " " << a.z;
}

TEST(Views, EyesFollowTheHead)
{
    User user;
    user.interpupillary_m = 0.06;
    user.eye_offset_m = {0, -0.05, -0.1};
    Eyes const still = eyes_of(user, RoomPose{{1, 2, 3}, {1, 0, 0, 0}});
    expect_near(still.left, {0.97, 1.95, 2.9});
    expect_near(still.right, {1.03, 1.95, 2.9});
    expect_near(still.middle, {1, 1.95, 2.9});
    // Turned to the left by 90 degrees, the head looks along -x and its right is -z.
    Eyes const turned = eyes_of(user, RoomPose{{1, 2, 3}, glm::angleAxis(glm::radians(90.0), gi::dvec3{0, 1, 0})});
    expect_near(turned.middle, {0.9, 1.95, 3});
    expect_near(turned.right - turned.left, {0, 0, -0.06});
    user.head = {{0, 1, 0}, {0, 90, 0}};
    expect_near(resting_head(user).rotation * gi::dvec3{0, 0, -1}, {-1, 0, 0});
}

TEST(Views, RotationsAreAboutXThenYThenZ)
{
    gi::dquat const q = pose_of({gi::dvec3{0}, {90, 90, 0}}).rotation;
    expect_near(q * gi::dvec3{0, 1, 0}, {1, 0, 0}); // y -> z about x, z -> x about y
}

TEST(Views, TwoForStereoOneWithout)
{
    Display d = shipped("cave4.yaml");
    d.walls[1].stereo = StereoMode::off;
    d.walls[2].swap_eyes = true;
    d.walls[3].stereo = StereoMode::side_by_side;
    auto const views = views_of(d, {});
    ASSERT_EQ(views.size(), 7u);
    EXPECT_EQ(views[0].name, "left, left eye");
    EXPECT_EQ(views[1].name, "left, right eye");
    EXPECT_EQ(views[0].partner, -1);
    EXPECT_EQ(views[1].partner, 0);
    EXPECT_EQ(views[2].name, "front, middle");
    EXPECT_EQ(views[2].partner, -1);
    EXPECT_EQ(views[3].eye, Eye::right); // in the left eye's place
    EXPECT_EQ(views[4].eye, Eye::left);
    EXPECT_EQ(views[4].partner, 3);
    EXPECT_EQ(views[5].width_px, 512);
    EXPECT_EQ(views[5].height_px, 1024);
    EXPECT_EQ(views_of(d, {}, 1).size(), 1u);
    EXPECT_EQ(views_of(d, {}, 9).size(), 0u);
}

TEST(Views, OnlyEyesThatSeeAreOrdered)
{
    Display d = shipped("cave4.yaml");
    // Within the left wall: one eye before it, one behind; the other walls are seen by both.
    std::vector<std::optional<RoomPose>> const heads{RoomPose{{-1.5, 1.75, 0.08}, {1, 0, 0, 0}}};
    auto const views = views_of(d, heads);
    ASSERT_EQ(views.size(), 8u);
    EXPECT_EQ(views[0].place, EyePlace::behind);
    EXPECT_EQ(views[1].place, EyePlace::before);
    gi::dmat4 world(2); // the user is twice as large as the world thinks
    world[3] = {10, 20, 30, 1};
    std::vector<int> sources;
    auto const commands = view_orders(views, world, &sources);
    ASSERT_EQ(commands.size(), 7u);
    EXPECT_EQ(sources, (std::vector<int>{1, 2, 3, 4, 5, 6, 7}));
    EXPECT_EQ(commands[0].partner, -1); // its partner is dark
    EXPECT_EQ(commands[2].partner, 1);
    gi::dmat4 const& m = commands[0].camera.world_from_camera;
    expect_near(gi::dvec3(m[3]), gi::dvec3{10, 20, 30} + 2.0 * gi::dvec3{-1.5 + 0.0315, 1.7, 0});
    for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(glm::length(gi::dvec3(m[axis])), 1, 1e-12);
    EXPECT_EQ(commands[0].camera.off_axis, views[1].camera->off_axis);
}

TEST(Views, NeighboursShareTheirPixelEdges)
{
    DisplayWindow const window{"w", 1001, 301, 0, 0, -1, false};
    int at = 0;
    for (int i = 0; i < 3; ++i) {
        Wall wall;
        wall.viewport = {LengthUnit::fraction, i / 3.0, 0, 1 / 3.0, 1};
        PixelRectangle const r = viewport_px(wall, window);
        EXPECT_EQ(r.x, at);
        EXPECT_EQ(r.height, 301);
        at += r.width;
    }
    EXPECT_EQ(at, 1001);
}

TEST(Views, FiguresOfAKnownWall)
{
    Display d = shipped("cave4.yaml");
    d.users[0].head.translation_m = {0, 1.5, 0};
    d.users[0].eye_offset_m = gi::dvec3{0};
    for (Wall& wall : d.walls) wall.stereo = StereoMode::off;
    auto const summary = summarise_views(d);
    ASSERT_EQ(summary.size(), 4u);
    EXPECT_NEAR(summary[1].horizontal_deg, 90, 1e-9);
    EXPECT_NEAR(summary[1].distance_m, 1.5, 1e-12);
    // 1024 pixels on 3 m, 1.5 m away: 512 pixels per radian in the middle.
    EXPECT_NEAR(summary[1].px_per_deg_across, glm::radians(512.0), 1e-4);
}

} // namespace
} // namespace viewer::test
