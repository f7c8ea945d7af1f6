// Morph targets and linear blend skinning: by hand, and against poses that other programs baked.

#include "gi/scene/load/load.h"
#include "gi/scene/motion/skinning.h"
#include "tests/support/data.h"
#include "tests/support/scenes.h"

#include <fmt/format.h>
#include <fstream>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace gi::test {
namespace {

/// A bar of two joints along +x: the second joint, at x = 1, turns by 90 degrees about z.
Scene bar_scene()
{
    Scene scene;
    add_quad(scene, {0, 0, 0}, {2, 0, 0}, {0, 1, 0}, add_material(scene, lambert(vec3{0.5f})));
    Mesh& m = scene.meshes[0];
    m.normals.assign(4, vec3{0, 0, 1});
    m.joints.assign(4, {0, 1, 0, 0});
    m.weights = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0.5f, 0.5f, 0, 0}, {1, 0, 0, 0}};
    Node root, joint;
    joint.parent = 1;
    joint.translation = {1, 0, 0};
    joint.rotation = glm::angleAxis(glm::half_pi<double>(), dvec3{0, 0, 1});
    scene.nodes.push_back(root);
    scene.nodes.push_back(joint);
    scene.skins = {{{1, 2}, {mat4(1), glm::translate(mat4(1), vec3{-1, 0, 0})}}};
    scene.nodes[0].skin = 0;
    return scene;
}

DeformedVertices deform_first(Scene const& scene)
{
    return deform(scene, evaluate_pose(scene, std::nullopt), 0, scene.meshes[0]);
}

TEST(Skinning, TwoJointsByHand)
{
    DeformedVertices const v = deform_first(bar_scene());
    EXPECT_LT(glm::distance(dvec3(v.positions[0]), dvec3{0, 0, 0}), 1e-9);
    EXPECT_LT(glm::distance(dvec3(v.positions[1]), dvec3{1, 1, 0}), 1e-9);
    EXPECT_LT(glm::distance(dvec3(v.positions[2]), 0.5 * (dvec3{2, 1, 0} + dvec3{0, 1, 0})), 1e-9);
    EXPECT_LT(glm::distance(dvec3(v.positions[3]), dvec3{0, 1, 0}), 1e-9);
    for (vec3 const n : v.normals) EXPECT_LT(glm::distance(n, vec3{0, 0, 1}), 1e-6f);
}

/// glTF 2, sec. 3.7.3.3: only the joints place a skinned mesh.
TEST(Skinning, TheNodesOwnTransformDoesNotCount)
{
    Scene scene = bar_scene();
    scene.nodes[0].translation = {100, 200, 300};
    scene.nodes[0].scale = {-5, 5, 5};
    DeformedVertices const v = deform_first(scene);
    EXPECT_LT(glm::distance(dvec3(v.positions[1]), dvec3{1, 1, 0}), 1e-9);
    EXPECT_FALSE(v.mirrored);
}

TEST(Skinning, WeightsAreRenormalised)
{
    Scene scene = bar_scene();
    for (vec4& w : scene.meshes[0].weights) w *= 0.9f;
    EXPECT_LT(glm::distance(dvec3(deform_first(scene).positions[1]), dvec3{1, 1, 0}), 1e-6);
}

TEST(Skinning, JointsThatMirrorTurnTheWinding)
{
    Scene scene = bar_scene();
    scene.nodes[1].scale = {1, 1, -1};
    EXPECT_TRUE(deform_first(scene).mirrored);
    World const w = world_of(scene);
    for (uvec3 const t : w.triangles) {
        vec3 const a = w.positions[t.x];
        EXPECT_LT(glm::cross(w.positions[t.y] - a, w.positions[t.z] - a).z, 0);
    }
}

TEST(Skinning, MorphTargetsAddUp)
{
    Scene scene;
    add_quad(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, add_material(scene, lambert(vec3{0.5f})));
    Mesh& m = scene.meshes[0];
    m.normals.assign(4, vec3{0, 0, 1});
    m.morph_targets = {{std::vector<vec3>(4, vec3{1, 0, 0}), {}, {}},
                       {std::vector<vec3>(4, vec3{0, 0, 2}), std::vector<vec3>(4, vec3{1, 0, -1}), {}}};
    scene.nodes[0].morph_weights = {0.5f, 1};
    scene.nodes[0].translation = {0, 10, 0};
    DeformedVertices const v = deform_first(scene);
    EXPECT_LT(glm::distance(dvec3(v.positions[0]), dvec3{0.5, 10, 2}), 1e-9);
    for (vec3 const n : v.normals) EXPECT_LT(glm::distance(n, vec3{1, 0, 0}), 1e-6f);
}

/// Vertices of a binary little-endian PLY that begins with float x, y, z.
std::vector<vec3> read_ply_positions(std::filesystem::path const& file)
{
    std::ifstream in(file, std::ios::binary);
    std::size_t count = 0;
    for (std::string line; std::getline(in, line) && line != "end_header";)
        if (line.starts_with("element vertex ")) count = std::stoul(line.substr(15));
    std::vector<vec3> v(count);
    in.read(reinterpret_cast<char*>(v.data()), std::streamsize(count * sizeof(vec3)));
    EXPECT_TRUE(in.good()) << file;
    return v;
}

/// Every frame of a baked sequence against the world at its time; tolerance 1e-5 of the size.
void expect_sequence(std::filesystem::path const& folder)
{
    std::ifstream in(folder / "sequence.json");
    nlohmann::json const sequence = nlohmann::json::parse(in);
    Report report;
    Scene scene = load_scene((folder.parent_path() / sequence.at("source").get<std::string>()).string(), report);
    Playback playback;
    if (sequence.at("animation").is_number())
        playback.animation = sequence.at("animation").get<std::int32_t>();
    else
        for (std::size_t i = 0; i < scene.animations.size(); ++i)
            if (scene.animations[i].name == sequence.at("animation").get<std::string>())
                playback.animation = std::int32_t(i);
    ASSERT_GE(playback.animation, 0);
    EXPECT_NEAR(scene.animations[std::size_t(playback.animation)].duration_s,
                sequence.at("duration_s").get<double>(), 1e-6);
    scene.playbacks = {playback};
    auto const shared = std::make_shared<Scene const>(std::move(scene));
    auto const times = sequence.at("times_s").get<std::vector<double>>();
    for (std::size_t frame = 0; frame < times.size(); ++frame) {
        World const world = build_world(shared, times[frame], report);
        std::vector<vec3> const expected = read_ply_positions(folder / fmt::format("frame_{:03}.ply", frame));
        ASSERT_EQ(world.positions.size(), expected.size());
        double worst = 0;
        for (std::size_t i = 0; i < expected.size(); ++i)
            worst = std::max(worst, glm::distance(dvec3(world.positions[i]) + world.origin, dvec3(expected[i])));
        EXPECT_LE(worst, 1e-5 * 2 * double(world.bounds.radius())) << "frame " << frame;
    }
}

TEST(Skinning, CesiumManWalks)
{
    LIGHTWELL_NEED_DATA(shared_data() / "avatars/cesium_man_walk_expected/sequence.json");
    expect_sequence(shared_data() / "avatars/cesium_man_walk_expected");
}

TEST(Skinning, FoxRuns)
{
    LIGHTWELL_NEED_DATA(shared_data() / "avatars/fox_run_expected/sequence.json");
    expect_sequence(shared_data() / "avatars/fox_run_expected");
}

TEST(Skinning, HorseGallops)
{
    LIGHTWELL_NEED_DATA(shared_data() / "avatars/horse_gallop_seq/sequence.json");
    expect_sequence(shared_data() / "avatars/horse_gallop_seq");
}

} // namespace
} // namespace gi::test
