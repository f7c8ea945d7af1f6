// From the node graph to world-space triangles: transforms, mirrors, far places, damaged vertices.

#include "tests/support/scenes.h"

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

namespace gi::test {
namespace {

World build(Scene scene, Report& report, SceneTime time_s = std::nullopt)
{
    return build_world(std::make_shared<Scene const>(std::move(scene)), time_s, report);
}

std::uint64_t lost(Report const& report, std::string const& word)
{
    std::uint64_t n = 0;
    for (auto const& [what, loss] : report.losses())
        if (what.find(word) != std::string::npos) n += loss.count;
    return n;
}

/// A unit square at z = 0 that faces +z, with normals and tangents along x.
Scene square_scene()
{
    Scene scene;
    add_quad(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, add_material(scene, lambert(vec3{0.5f})));
    scene.meshes[0].normals.assign(4, vec3{0, 0, 1});
    scene.meshes[0].tangents.assign(4, vec4{1, 0, 0, 1});
    return scene;
}

dvec3 face_normal(World const& w, std::size_t triangle)
{
    uvec3 const t = w.triangles[triangle];
    dvec3 const a(w.positions[t.x]), b(w.positions[t.y]), c(w.positions[t.z]);
    return glm::normalize(glm::cross(b - a, c - a));
}

TEST(World, EmptySceneIsAnEmptyWorld)
{
    World const w = world_of({});
    EXPECT_TRUE(w.triangles.empty());
    EXPECT_TRUE(w.bounds.empty());
    EXPECT_EQ(w.materials.size(), 1u);
    EXPECT_TRUE(view(w).light_select.empty());
}

TEST(World, NodesOfOneMeshAreInstances)
{
    Scene scene = square_scene();
    Node second;
    second.meshes = {0};
    second.translation = {5, 0, 0};
    scene.nodes.push_back(second);
    World const w = world_of(scene);
    EXPECT_EQ(w.instances, 2u);
    EXPECT_EQ(w.triangles.size(), 4u);
    EXPECT_EQ(w.positions.size(), 8u);
    EXPECT_EQ(w.bounds.high, (vec3{6, 1, 0}));
}

TEST(World, MeshesWithoutMaterialGetTheDefault)
{
    Scene scene = square_scene();
    scene.meshes[0].material = -1;
    World const w = world_of(scene);
    EXPECT_EQ(w.triangle_material, (std::vector<std::uint32_t>{1, 1}));
    EXPECT_EQ(w.materials[1].base_color, Material{}.base_color);
}

TEST(World, AttributesAreFilledWhereAMeshHasNone)
{
    Scene scene = square_scene();
    scene.meshes[0].uv0.assign(4, vec2{0.5f});
    scene.meshes[0].colors.assign(4, vec3{0.25f});
    add_quad(scene, {0, 0, 5}, {1, 0, 0}, {0, 1, 0}, 0);
    World const w = world_of(scene);
    ASSERT_EQ(w.normals.size(), 8u);
    ASSERT_EQ(w.uv0.size(), 8u);
    EXPECT_TRUE(w.uv1.empty());
    EXPECT_EQ(w.normals[7], vec3{0});
    EXPECT_EQ(w.tangents[7], vec4{0});
    EXPECT_EQ(w.uv0[7], vec2{0});
    EXPECT_EQ(w.colors[7], vec3{1});
    EXPECT_EQ(w.colors[0], vec3{0.25f});
}

/// A mirror image faces where the mirrored front faced, and its normals say the same.
TEST(World, MirroredTransformsKeepTheFront)
{
    for (dvec3 const scale :
         {dvec3{-1, 1, 1}, dvec3{1, -2, 1}, dvec3{-3, -1, -1}, dvec3{-1, -1, 1}, dvec3{1, 1, -1}}) {
        Scene scene = square_scene();
        scene.nodes[0].scale = scale;
        World const w = world_of(scene);
        vec3 const expected{0, 0, scale.z < 0 ? -1 : 1};
        ASSERT_EQ(w.triangles.size(), 2u);
        for (std::size_t i = 0; i < 2; ++i) EXPECT_LT(glm::distance(face_normal(w, i), dvec3(expected)), 1e-6);
        for (vec3 const n : w.normals) EXPECT_LT(glm::distance(n, expected), 1e-6f);
        // The bitangent w * cross(n, t) is the image of +y.
        vec4 const t = w.tangents[0];
        vec3 const bitangent = t.w * glm::cross(w.normals[0], vec3(t));
        EXPECT_LT(glm::distance(bitangent, vec3{0, scale.y < 0 ? -1 : 1, 0}), 1e-6f);
        EXPECT_LT(glm::distance(vec3(t), vec3{scale.x < 0 ? -1 : 1, 0, 0}), 1e-6f);
    }
}

TEST(World, NormalsStayPerpendicularUnderUnevenScale)
{
    Scene scene = square_scene();
    scene.nodes[0].matrix = glm::scale(dmat4(1), dvec3{1, 1, 7}) * glm::rotate(dmat4(1), 0.7, dvec3{1, 0, 0});
    World const w = world_of(scene);
    for (vec3 const n : w.normals) EXPECT_LT(glm::distance(dvec3(n), face_normal(w, 0)), 1e-6);
}

/// A node squeezed flat still has its normal where the surface does.
TEST(World, FlattenedNodesKeepFiniteNormals)
{
    Scene scene = square_scene();
    scene.nodes[0].scale = {2, 3, 0};
    World const w = world_of(scene);
    ASSERT_EQ(w.triangles.size(), 2u);
    for (vec3 const n : w.normals) EXPECT_LT(glm::distance(n, vec3{0, 0, 1}), 1e-6f);
}

TEST(World, DetailSurvivesAThousandKilometresAway)
{
    Scene scene = square_scene();
    for (vec3& p : scene.meshes[0].positions) p *= 1e-3f;
    dvec3 const away{1e6, -1e6, 1e6};
    scene.nodes[0].translation = away;
    World const w = world_of(scene);
    ASSERT_EQ(w.triangles.size(), 2u);
    for (std::size_t i = 0; i < 4; ++i) {
        dvec3 const expected = dvec3(scene.meshes[0].positions[i]) + away;
        EXPECT_LT(glm::distance(dvec3(w.positions[i]) + w.origin, expected), 1e-9);
    }
    EXPECT_LT(glm::length(dvec3(w.bounds.center())), 1e-6);
}

TEST(World, NearbyScenesKeepTheirOrigin)
{
    Scene scene = square_scene();
    scene.nodes[0].translation = {100, 0, 0};
    EXPECT_EQ(world_of(scene).origin, dvec3{0});
}

TEST(World, LightsAndCamerasFollowTheOrigin)
{
    Scene scene = square_scene();
    dvec3 const away{5e6, 0, 0};
    Node root;
    root.translation = away;
    scene.nodes.insert(scene.nodes.begin(), root);
    scene.nodes[1].parent = 0;
    Node lamp;
    lamp.parent = 0;
    lamp.translation = {0, 3, 0};
    lamp.scale = {2, 5, 0.1};
    lamp.rotation = glm::angleAxis(-glm::half_pi<double>(), dvec3{1, 0, 0}); // -z to -y
    lamp.light = 0;
    Light light;
    light.type = LightType::spot;
    light.intensity = vec3{7};
    scene.lights.push_back(light);
    Node eye = lamp;
    eye.light = -1;
    eye.camera = 0;
    eye.scale = {-2, 5, 0.1};
    scene.nodes.push_back(lamp);
    scene.nodes.push_back(eye);
    scene.cameras.resize(1);
    World const w = world_of(scene);
    ASSERT_EQ(w.lights.size(), 1u);
    EXPECT_LT(glm::distance(dvec3(w.lights[0].position) + w.origin, away + dvec3{0, 3, 0}), 1e-5);
    EXPECT_LT(glm::distance(w.lights[0].direction, vec3{0, -1, 0}), 1e-6f);
    EXPECT_EQ(w.lights[0].intensity, vec3{7});
    ASSERT_EQ(w.cameras.size(), 1u);
    glm::dmat3 const m(w.cameras[0].world_from_camera);
    EXPECT_LT(glm::distance(dvec3(w.cameras[0].world_from_camera[3]), away + dvec3{0, 3, 0}), 1e-9);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(glm::length(m[c]), 1, 1e-12);
    EXPECT_NEAR(glm::determinant(m), 1, 1e-12);
}

TEST(World, DamagedTrianglesAreSkippedAndCounted)
{
    float const nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
    Scene scene = square_scene();
    Mesh& m = scene.meshes[0];
    m.name = "door";
    m.positions.insert(m.positions.end(),
                       {vec3{nan, 0, 0}, vec3{0, inf, 0}, vec3{0, 0, 1e19f}, vec3{0.5f, 0.5f, 0}});
    m.normals.resize(m.positions.size(), vec3{nan});
    m.tangents.resize(m.positions.size(), vec4{inf});
    m.triangles.insert(m.triangles.end(), {{0, 1, 4}, {0, 5, 1}, {6, 0, 1}, {0, 7, 2}, {3, 3, 3}});
    Report report;
    World const w = build(scene, report);
    EXPECT_EQ(w.triangles.size(), 2u);
    EXPECT_EQ(w.triangle_material.size(), 2u);
    EXPECT_EQ(lost(report, "not finite"), 3u);
    EXPECT_EQ(lost(report, "without area"), 2u);
    for (auto const& [what, loss] : report.losses()) EXPECT_EQ(loss.first, "mesh 'door'") << what;
    EXPECT_EQ(w.bounds.low, vec3{0});
    EXPECT_EQ(w.bounds.high, (vec3{1, 1, 0}));
    for (uvec3 const t : w.triangles)
        for (int k = 0; k < 3; ++k) EXPECT_TRUE(all_finite(w.normals[t[k]]));
}

/// What has area in double but none as floats would give normals that are not numbers.
TEST(World, TrianglesThatFloatsCannotHoldAreSkipped)
{
    Scene scene = square_scene();
    Node speck;
    speck.meshes = {0};
    speck.translation = {1000, 1000, 1000};
    speck.scale = dvec3{1e-7};
    scene.nodes.push_back(speck);
    Report report;
    World const w = build(scene, report);
    EXPECT_EQ(w.triangles.size(), 2u);
    EXPECT_EQ(lost(report, "without area"), 2u);
}

TEST(World, DamagedLightsAreSkippedAndCounted)
{
    Scene scene = square_scene();
    scene.lights.resize(1);
    Node lamp;
    lamp.light = 0;
    lamp.translation.x = std::numeric_limits<double>::infinity();
    scene.nodes.push_back(lamp);
    Report report;
    World const w = build(scene, report);
    EXPECT_TRUE(w.lights.empty());
    EXPECT_EQ(lost(report, "lights"), 1u);
}

TEST(World, HugeCoordinatesStayFinite)
{
    Scene scene = square_scene();
    scene.nodes[0].scale = dvec3{1e17};
    Report report;
    World const w = build(scene, report);
    EXPECT_EQ(w.triangles.size(), 2u);
    EXPECT_TRUE(std::isfinite(view(w).scene_radius));
}

TEST(World, AppendKeepsEverythingTogether)
{
    Scene scene = square_scene();
    Scene part = square_scene();
    part.materials[0].base_color_map.texture = 0;
    part.textures.texels.resize(4);
    part.textures.textures.resize(1);
    part.skins = {{{0}, {mat4(1)}}};
    part.animations.resize(1);
    part.animations[0].channels.resize(1);
    part.animations[0].channels[0].node = 0;
    part.playbacks = {{0, 0, 1, true}};
    part.nodes[0].skin = 0;
    Scene const twin = part;
    append(scene, part, "one", glm::translate(dmat4(1), dvec3{10, 0, 0}));
    append(scene, twin, "two", glm::translate(dmat4(1), dvec3{20, 0, 0}));

    ASSERT_EQ(scene.nodes.size(), 5u);
    EXPECT_EQ(scene.nodes[3].name, "two");
    EXPECT_EQ(scene.nodes[4].parent, 3);
    EXPECT_EQ(scene.nodes[4].meshes, std::vector<std::int32_t>{2});
    EXPECT_EQ(scene.nodes[4].skin, 1);
    EXPECT_EQ(scene.meshes[2].material, 2);
    EXPECT_EQ(scene.materials[2].base_color_map.texture, 1);
    EXPECT_EQ(scene.textures.textures[1].first, 4u);
    EXPECT_EQ(scene.skins[1].joints, std::vector<std::int32_t>{4});
    EXPECT_EQ(scene.animations[1].channels[0].node, 4);
    EXPECT_EQ(scene.playbacks[1].animation, 1);
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) EXPECT_LT(scene.nodes[i].parent, std::int32_t(i));
    for (Animation& a : scene.animations) a.channels.clear();
    for (Node& n : scene.nodes) n.skin = -1;
    EXPECT_EQ(world_of(scene).bounds.high, (vec3{21, 1, 0}));
}

TEST(World, TimeMovesWhatPlays)
{
    Scene scene = square_scene();
    AnimationChannel c;
    c.node = 0;
    c.times_s = {0, 1};
    c.values = {0, 0, 0, 4, 0, 0};
    Animation clip;
    clip.duration_s = 1;
    clip.channels = {c};
    scene.animations = {clip};
    scene.playbacks = {{0, 0, 1, true}};
    Report report;
    EXPECT_EQ(build(scene, report).bounds.low.x, 0);
    EXPECT_FLOAT_EQ(build(scene, report, 0.25).bounds.low.x, 1);
    EXPECT_FLOAT_EQ(build(scene, report, 5.5).bounds.low.x, 2);
}

} // namespace
} // namespace gi::test
