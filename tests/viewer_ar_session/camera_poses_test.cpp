// Camera poses from scene files.

#include "ar/scene/camera_poses.h"

#include "gi/core/error.h"
#include "tests/viewer/run_program.h"

namespace viewer::test {
namespace {

/// A camera that moves from (0, 1, 2) to (1, 1, 2) in a second, under a node that turns it
/// to look along +x and doubles its scale.
std::string scene(std::string const& more = "", std::string const& roots = "0")
{
    return R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [)" + roots + R"(]}],
 "nodes": [{"children": [1], "rotation": [0, -0.7071067811865476, 0, 0.7071067811865476], "scale": [2, 2, 2]},
           {"camera": 0})" +
           more + R"(],
 "cameras": [{"type": "perspective", "perspective": {"yfov": 0.8, "znear": 0.1}}],
 "animations": [{"channels": [{"sampler": 0, "target": {"node": 1, "path": "translation"}}],
                 "samplers": [{"input": 0, "output": 1}]}],
 "accessors": [{"bufferView": 0, "componentType": 5126, "count": 2, "type": "SCALAR", "min": [0], "max": [1]},
               {"bufferView": 1, "componentType": 5126, "count": 2, "type": "VEC3"}],
 "bufferViews": [{"buffer": 0, "byteLength": 8}, {"buffer": 0, "byteOffset": 8, "byteLength": 24}],
 "buffers": [{"byteLength": 32, "uri": "data:application/octet-stream;base64,AAAAAAAAgD8AAAAAAACAPwAAAEAAAIA/AACAPwAAAEA="}]})";
}

TEST(CameraPoses, ComeFromAnAnimatedCamera)
{
    TemporaryFolder const folder;
    std::ofstream(folder / "shot.gltf") << scene();
    gi::Report report;
    auto const poses = ar::read_camera_poses(folder / "shot.gltf", {10}, report).poses;
    ASSERT_EQ(poses.size(), 11u);
    for (std::size_t f = 0; f < poses.size(); ++f) {
        double const t = double(f) / 10;
        EXPECT_NEAR(poses[f].time_s, t, 1e-12);
        // A quarter turn clockwise seen from above takes (x, y, z) to (-z, y, x).
        glm::dvec3 const wanted(-4, 2, 2 * t);
        EXPECT_LT(glm::distance(poses[f].world_from_camera.position, wanted), 1e-6) << f;
        glm::dvec3 const ahead = poses[f].world_from_camera.rotation * glm::dvec3(0, 0, 1),
                         down = poses[f].world_from_camera.rotation * glm::dvec3(0, 1, 0);
        EXPECT_LT(glm::distance(ahead, glm::dvec3(1, 0, 0)), 1e-6);
        EXPECT_LT(glm::distance(down, glm::dvec3(0, -1, 0)), 1e-6);
    }
}

TEST(CameraPoses, NeedOneCamera)
{
    TemporaryFolder const folder;
    gi::Report report;
    std::ofstream(folder / "two.gltf") << scene(R"(, {"camera": 0})", "0, 2");
    EXPECT_THROW(ar::read_camera_poses(folder / "two.gltf", {10}, report), gi::InputError);
    std::ofstream(folder / "none.gltf") << R"({"asset": {"version": "2.0"}, "nodes": [{}]})";
    EXPECT_THROW(ar::read_camera_poses(folder / "none.gltf", {10}, report), gi::InputError);
    EXPECT_THROW(ar::read_camera_poses(folder / "shot.gltf", {10, 4}, report), gi::InputError) << "has no numbers";
    EXPECT_THROW(ar::read_camera_poses(folder / "missing.glb", {10}, report), gi::InputError);
}

} // namespace
} // namespace viewer::test
