// Where a wand's ray meets walls, and where menus go.

#include "tests/viewer_display/display_samples.h"
#include "viewer/displays/wall_ray.h"

namespace viewer::test {
namespace {

RoomPose pointing(gi::dvec3 from, double yaw_deg)
{
    return {from, glm::angleAxis(glm::radians(yaw_deg), gi::dvec3{0, 1, 0})};
}

TEST(WallRay, MeetsTheNearestFront)
{
    Display const cave = shipped("cave5.yaml"); // 3 m wide, origin in the middle of the floor
    auto const front = hit_wall(cave, pointing({0.3, 1.2, 0.5}, 0));
    ASSERT_TRUE(front);
    EXPECT_EQ(cave.walls[std::size_t(front->wall)].name, "front");
    EXPECT_NEAR(front->u, 0.6, 1e-12);
    EXPECT_NEAR(front->v, 0.4, 1e-12);
    EXPECT_NEAR(front->distance_m, 2, 1e-12);
    EXPECT_EQ(cave.walls[std::size_t(hit_wall(cave, pointing({0, 1, 0}, 90))->wall)].name, "left");
    EXPECT_FALSE(hit_wall(cave, pointing({0, 1, 0}, 180))) << "there is no back wall";
    EXPECT_FALSE(hit_wall(cave, pointing({0, 1, -5}, 180))) << "the back of the front wall";
    EXPECT_FALSE(hit_wall(cave, pointing({0, 1, 0}, 0), 3)) << "no wall of rank 3";
    auto const beside = hit_plane(cave, front->wall, pointing({0, 1, 0}, 60));
    ASSERT_TRUE(beside);
    EXPECT_LT(beside->u, 0);
}

TEST(WallRay, MenusStayOnTheirWall)
{
    WallFrame const wall = wall_frame({{-1.5, 0, -1.5}, {1.5, 0, -1.5}, {-1.5, 3, -1.5}});
    WallRectangle const middle = menu_place(wall, 0.5, 0.5);
    EXPECT_NEAR(middle.width * 3, 0.75, 1e-12);
    EXPECT_NEAR(middle.height * 3, 0.95, 1e-12);
    EXPECT_NEAR(middle.left + 0.5 * middle.width, 0.5, 1e-12);
    WallHit corner;
    corner.u = middle.left;
    corner.v = middle.bottom + middle.height;
    EXPECT_LT(glm::length(middle.inside(corner)), 1e-12) << "its top left corner";
    WallRectangle const edge = menu_place(wall, 1, 0);
    EXPECT_NEAR(edge.left + edge.width, 1, 1e-12);
    EXPECT_NEAR(edge.bottom, 0, 1e-12);
    WallRectangle const small = menu_place(wall_frame({{0, 0, 0}, {0.4, 0, 0}, {0, 0.3, 0}}), 0.5, 0.5);
    EXPECT_NEAR(small.width, 0.8, 1e-12);
    EXPECT_NEAR(small.height, 0.8, 1e-12);
}

} // namespace
} // namespace viewer::test
