#include "ar/pose/pose_file.h"

#include "gi/core/error.h"
#include "gi/core/rotation.h"

#include <gtest/gtest.h>

namespace ar::test {
namespace {

std::string refusal(std::string const& text)
{
    try {
        parse_poses(text, "walk.txt");
    } catch (gi::InputError const& e) {
        return e.what();
    }
    return "";
}

TEST(PoseFile, OfEitherFormatIsRead)
{
    auto const tum = parse_poses("# a comment\n0.5 1 2 3 0 0 0 1\r\n1.5\t1  2 4 0 0.6 0 0.8\n", "a");
    ASSERT_EQ(tum.size(), 2u);
    EXPECT_EQ(tum[0].world_from_camera.position, glm::dvec3(1, 2, 3));
    EXPECT_NEAR(tum[1].world_from_camera.rotation.y, 0.6, 1e-12);
    auto const csv = parse_poses(format_poses(tum), "b");
    ASSERT_EQ(csv.size(), 2u);
    EXPECT_EQ(csv[1].world_from_camera.position, tum[1].world_from_camera.position);
    EXPECT_EQ(csv[1].time_s, 1.5);
}

TEST(PoseFile, OfGraphicsAxesLooksTheSameWay)
{
    auto const p = parse_poses("0 0 0 0 0 0 0 1\n", "a", CameraAxes::graphics);
    glm::dvec3 const ahead = p[0].world_from_camera.rotation * glm::dvec3(0, 0, 1);
    glm::dvec3 const down = p[0].world_from_camera.rotation * glm::dvec3(0, 1, 0);
    EXPECT_NEAR(ahead.z, -1, 1e-12);
    EXPECT_NEAR(down.y, -1, 1e-12);
}

TEST(PoseFile, SaysWhereItIsWrong)
{
    EXPECT_EQ(refusal("0 0 0 0 0 0 0 1\n1 0 x 0 0 0 0 1\n").substr(0, 13), "walk.txt:2:5:");
    EXPECT_EQ(refusal("0 0 0 0 0 0 0 1\n1 0 0 0 0 0 0\n").substr(0, 13), "walk.txt:2:1:");
    EXPECT_EQ(refusal("0 0 0 0 0 0 0 1\n0 0 0 0 0 0 0 1\n").substr(0, 13), "walk.txt:2:1:");
    EXPECT_EQ(refusal("0 0 0 0 0 0 0 2\n").substr(0, 13), "walk.txt:1:9:");
    EXPECT_EQ(refusal("0 0 0 nan 0 0 0 1\n").substr(0, 13), "walk.txt:1:7:");
    EXPECT_EQ(refusal("time_s,x_m,y_m,z,qx,qy,qz,qw\n").substr(0, 14), "walk.txt:1:16:");
    EXPECT_EQ(refusal("time_s,x_m,y_m,z_m,qx,qy,qz,qw\n0,,0,0,0,0,0,1\n").substr(0, 13), "walk.txt:2:3:");
    EXPECT_NE(refusal("# nothing\n"), "");
    EXPECT_THROW(read_poses("/nowhere/walk.txt", {30}), gi::InputError);
    EXPECT_THROW(read_poses("/tmp", {30}), gi::InputError);
}

TEST(PoseFile, IsReadBetweenItsTimes)
{
    std::vector<TimedPose> const poses{{0, {{0, 0, 0}, {1, 0, 0, 0}}},
                                       {0.4, {{4, 0, 0}, gi::exp_rotation({0, 0.8, 0})}},
                                       {2, {{8, 0, 0}, gi::exp_rotation({0, 0.8, 0})}}};
    EXPECT_NEAR(pose_at(poses, 0.1)->position.x, 1, 1e-12);
    EXPECT_NEAR(gi::log_rotation(pose_at(poses, 0.1)->rotation).y, 0.2, 1e-12);
    EXPECT_EQ(pose_at(poses, 0.4)->position.x, 4);
    EXPECT_FALSE(pose_at(poses, -0.01));
    EXPECT_FALSE(pose_at(poses, 2.01));
    EXPECT_FALSE(pose_at(poses, 1));
    EXPECT_TRUE(pose_at(poses, 1, 5));
    EXPECT_FALSE(pose_at({}, 0));
}

} // namespace
} // namespace ar::test
