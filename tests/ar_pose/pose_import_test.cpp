// Poses of other programs: their axes and units against a camera that is known, and what is wrong with files.

#include "ar/pose/pose_import.h"

#include "gi/core/error.h"

#include <fmt/format.h>
#include <fstream>
#include <gtest/gtest.h>

namespace ar::test {
namespace {

/// At (1, 2, 3) in a world with y up, looking along -x, its right side towards -z, upright.
gi::RigidPose known()
{
    glm::dvec3 const right(0, 0, -1), down(0, -1, 0), ahead(-1, 0, 0);
    return {{1, 2, 3}, glm::quat_cast(glm::dmat3(right, down, ahead))};
}

void expect_known(gi::RigidPose const& p)
{
    EXPECT_LT(glm::length(p.position - known().position), 1e-9);
    EXPECT_LT(angle_between_deg(p.rotation, known().rotation), 1e-5);
    // 5 m in front of the camera, 1 m to the right and 0.5 m up.
    EXPECT_LT(glm::length(p * glm::dvec3(1, -0.5, 5) - glm::dvec3(-4, 2.5, 2)), 1e-9);
}

std::string refusal(auto const& read)
{
    try {
        read();
    } catch (gi::InputError const& e) {
        return e.what();
    }
    return {};
}

TEST(PoseImport, OfNukeHasItsAxes)
{
    // Looking along -z turned by 90 degrees about y looks along -x.
    auto const poses =
        parse_chan("# frame tx ty tz rx ry rz vfov\n12 1 2 3 0 90 0 45\n13 1 2 3 0 90 0 45\n\n18 0 0 0 0 0 0\n",
                   "a.chan", {24})
            .poses;
    ASSERT_EQ(poses.size(), 3u);
    expect_known(poses[0].world_from_camera);
    EXPECT_EQ(poses[0].time_s, 0);
    EXPECT_NEAR(poses[2].time_s, 6 / 24.0, 1e-12);
    // About x first, then y: looking up by 30 degrees, then turned.
    gi::RigidPose const up = parse_chan("1 0 0 0 30 90 0\n", "a.chan", {24}).poses[0].world_from_camera;
    EXPECT_LT(glm::length(up.rotation * glm::dvec3(0, 0, 1) - glm::dvec3(-std::sqrt(0.75), 0.5, 0)), 1e-9);
    EXPECT_LT(glm::length(up.rotation * glm::dvec3(1, 0, 0) - glm::dvec3(0, 0, -1)), 1e-9) << "level";
}

TEST(PoseImport, OfNukeHasTheOrderOfItsCamera)
{
    // Turned by 90 degrees about each of two axes, (1, 0, 0) goes to where the order says; the camera's x is its own.
    struct Case {
        char const *order, *angles;
        glm::dvec3 x, back;
    };
    for (Case const& c : {
             Case{"ZXY", "90 0 90", {0, 0, 1}, {0, -1, 0}}, // about z: (0, 1, 0), then about x: (0, 0, 1)
             Case{"XYZ", "90 0 90", {0, 1, 0}, {1, 0, 0}},  // about x: stays, then about z
             Case{"XYZ", "0 90 90", {0, 0, -1}, {0, 1, 0}}, // about y: (0, 0, -1), then about z
             Case{"ZYX", "0 90 90", {0, 1, 0}, {1, 0, 0}},  // about z: (0, 1, 0), then about y
             Case{"YXZ", "90 90 0", {0, 1, 0}, {1, 0, 0}},  // about y: (0, 0, -1), then about x
             Case{"XZY", "0 90 90", {0, 1, 0}, {1, 0, 0}},  // about z, then about y
             Case{"YZX", "0 90 90", {0, 0, -1}, {0, 1, 0}}, // about y, then about z
         }) {
        auto const order = rotation_order_named(c.order);
        ASSERT_TRUE(order);
        PoseFile const file = parse_chan(fmt::format("1 0 0 0 {}\n", c.angles), "a.chan", {24, {}, order});
        glm::dquat const turn = file.poses[0].world_from_camera.rotation;
        EXPECT_LT(glm::length(turn * glm::dvec3(1, 0, 0) - c.x), 1e-9) << c.order << " " << c.angles;
        EXPECT_LT(glm::length(turn * glm::dvec3(0, 0, -1) - c.back), 1e-9) << c.order << " " << c.angles;
        EXPECT_EQ(name_of(*file.order), c.order);
    }
    EXPECT_EQ(parse_chan("1 0 0 0 1 2 3\n", "a.chan", {24}).order, RotationOrder::zxy) << "as Nuke's cameras";
    EXPECT_FALSE(rotation_order_named("zxy"));
    EXPECT_FALSE(rotation_order_named("XX"));
    std::filesystem::path const tum = std::filesystem::path(testing::TempDir()) / "lightwell_no_angles.txt";
    std::ofstream(tum) << "0 1 2 3 0 0 0 1\n";
    EXPECT_THROW(read_poses(tum, {10, {}, RotationOrder::xyz}), gi::InputError);
    EXPECT_FALSE(read_poses(tum, {10}).order);
}

TEST(PoseImport, OfColmapIsCameraFromWorld)
{
    gi::RigidPose const camera_from_world = inverse(known());
    glm::dquat const q = camera_from_world.rotation;
    glm::dvec3 const t = camera_from_world.position;
    std::string const pose = fmt::format("{} {} {} {} {} {} {}", q.w, q.x, q.y, q.z, t.x, t.y, t.z);
    std::string const text = "# Image list with two lines of data per image:\n2 " + pose +
                             " 1 walk/000007.png\n\n1 " + pose + " 1 walk/000004.png\n1.5 2.5 -1 3 4 17\n";
    EXPECT_EQ(pose_format(text, "images.txt"), PoseFormat::colmap);
    auto const poses = parse_colmap_images(text, "images.txt", {30}).poses;
    ASSERT_EQ(poses.size(), 2u);
    expect_known(poses[0].world_from_camera);
    EXPECT_NEAR(poses[1].time_s, 0.1, 1e-12) << "by the numbers of pictures";
}

TEST(PoseImport, OfBlenderHasZUp)
{
    // Blender: (x, y, z) of a world with z up is our (x, z, -y). Its camera looks along its -z with y up: the
    // axes' columns are right (0, 1, 0), up (0, 0, 1), back (1, 0, 0).
    glm::dquat const q = glm::quat_cast(glm::dmat3(glm::dvec3(0, 1, 0), glm::dvec3(0, 0, 1), glm::dvec3(1, 0, 0)));
    auto const poses =
        parse_blender_json(
            fmt::format(
                "{{\"lightwell_camera\": 1, \"fps\": 25, \"frames\": [\n{{\"frame\": 1, \"position\": [1, -3, 2], "
                "\"rotation_wxyz\": [{}, {}, {}, {}]}},\n{{\"frame\": 6, \"position\": [0, 0, 0], "
                "\"rotation_wxyz\": [1, 0, 0, 0]}}]}}",
                q.w, q.x, q.y, q.z),
            "camera.json", {})
            .poses;
    ASSERT_EQ(poses.size(), 2u);
    expect_known(poses[0].world_from_camera);
    EXPECT_NEAR(poses[1].time_s, 0.2, 1e-12);
    EXPECT_LT(glm::length(poses[1].world_from_camera.rotation * glm::dvec3(0, 0, 1) - glm::dvec3(0, -1, 0)), 1e-9)
        << "without a rotation Blender's camera looks down";
}

TEST(PoseImport, ChoosesByNameAndContent)
{
    EXPECT_EQ(pose_format("", "walk.chan"), PoseFormat::nuke_chan);
    EXPECT_EQ(pose_format("", "walk.json"), PoseFormat::blender_json);
    EXPECT_EQ(pose_format("0 1 2 3 0 0 0 1\n", "walk.txt"), PoseFormat::csv_or_tum);
    EXPECT_EQ(pose_format("time_s,x_m,y_m,z_m,qx,qy,qz,qw\n", "walk.csv"), PoseFormat::csv_or_tum);
    std::filesystem::path const file = std::filesystem::path(testing::TempDir()) / "lightwell_pose_import.chan";
    std::ofstream(file) << "1 1 2 3 0 90 0\n2 1 2 3 0 90 0\n";
    auto const poses = read_poses(file, {10}).poses;
    expect_known(poses[0].world_from_camera);
    EXPECT_NEAR(poses[1].time_s, 0.1, 1e-12);
    std::filesystem::remove(file);
}

TEST(PoseImport, TimesFramesByTheNumberOfTheFirst)
{
    std::string const text = "7 1 0 0 0 0 0\n9 2 0 0 0 0 0\n";
    PoseFile const own = parse_chan(text, "a.chan", {10});
    EXPECT_EQ(own.first_frame, 7);
    EXPECT_EQ(own.poses[0].time_s, 0);
    PoseFile const named = parse_chan(text, "a.chan", {10, 4}); // the first three frames have no pose
    EXPECT_EQ(named.first_frame, 4);
    EXPECT_NEAR(named.poses[0].time_s, 0.3, 1e-12);
    EXPECT_NEAR(named.poses[1].time_s, 0.5, 1e-12);
    EXPECT_NEAR(parse_chan(text, "a.chan", {10, 8}).poses[0].time_s, -0.1, 1e-12);
    EXPECT_EQ(refusal([&] {
                  parse_chan(text, "a.chan", {10, 10});
              }).find("a.chan:2:1: the last pose is of frame 9"),
              0u);
    std::filesystem::path const file = std::filesystem::path(testing::TempDir()) / "lightwell_timed_poses.txt";
    std::ofstream(file) << "0 1 2 3 0 0 0 1\n";
    EXPECT_FALSE(read_poses(file, {10}).first_frame);
    EXPECT_NE(refusal([&] { read_poses(file, {10, 4}); }).find("times, not numbers"), std::string::npos);
    std::filesystem::remove(file);
}

TEST(PoseImport, SaysWhereFilesAreBroken)
{
    auto const chan = [](std::string const& t) { return refusal([&] { parse_chan(t, "a.chan", {24}); }); };
    EXPECT_EQ(chan("1 0 0 0 0 0 0\n2 0 zero 0 0 0 0\n").find("a.chan:2:5"), 0u);
    EXPECT_EQ(chan("1 0 0 0 nan 0 0\n").find("a.chan:1:9"), 0u);
    EXPECT_EQ(chan("1 0 0 0\n").find("a.chan:1:1"), 0u);
    EXPECT_EQ(chan("1 0 0 0 0 0 0\n1 0 0 0 0 0 0\n").find("a.chan:2:1: frame 1 is there twice"), 0u)
        << chan("1 0 0 0 0 0 0\n1 0 0 0 0 0 0\n");
    EXPECT_NE(chan("# nothing\n").find("no poses"), std::string::npos);
    auto const colmap = [](std::string const& t) {
        return refusal([&] { parse_colmap_images(t, "images.txt", {30}); });
    };
    EXPECT_EQ(colmap("1 1 0 0 0 0 0 0 1 picture.png\n\n").find("images.txt:1:19"), 0u);
    EXPECT_EQ(colmap("# list\n1 2 0 0 0 0 0 0 1 1.png\n\n").find("images.txt:2:3"), 0u);
    EXPECT_EQ(colmap("1 1 0 0 0 0 0 x 1 1.png\n\n").find("images.txt:1:15"), 0u);
    EXPECT_EQ(colmap("1 1 0 0 0 0 0 0 1 1.png\n1.5 2.5 -1\n3 4\n").find("images.txt:3:1"), 0u)
        << "the second line of an image is its points";
    std::string const image = "1 1 0 0 0 0 0 0 1 ";
    EXPECT_EQ(colmap(image + "1.png\n" + image + "2.png\n").find("images.txt:2:1: this is no line of points"), 0u)
        << "without empty lines every second pose would be lost";
    EXPECT_EQ(colmap(image + "a b 1.png\n" + image + "a b 2.png\n").find("images.txt:2:1"), 0u) << "12 words";
    EXPECT_EQ(colmap(image + "a b 1.png\n\n" + image + "a b 2.png\n"), "");
    EXPECT_EQ(
        colmap(image + "1696123456789.png\n\n").find("images.txt:1:19: the number 1696123456789 is more than"),
        0u);
    auto const blender = [](std::string const& t) {
        return refusal([&] { parse_blender_json(t, "c.json", {}); });
    };
    EXPECT_EQ(blender("{").find("c.json:1"), 0u);
    EXPECT_EQ(blender("{\"frames\": []}").find("c.json:1"), 0u);
    EXPECT_NE(blender("{\"lightwell_camera\": 1, \"fps\": 24, \"frames\": []}").find("no poses"),
              std::string::npos);
    std::string const head = "{\"lightwell_camera\": 1, \"fps\": 24, \"frames\": [\n";
    EXPECT_EQ(blender(head + "{\"frame\": 1, \"position\": [0, 0, 0], \"rotation_wxyz\": [0, 0, 0, 0]}]}")
                  .find("c.json:2:"),
              0u);
    EXPECT_EQ(blender(head + "{\"frame\": 1, \"position\": [0, 0], \"rotation_wxyz\": [1, 0, 0, 0]}]}")
                  .find("c.json:2:"),
              0u);
}

} // namespace
} // namespace ar::test
