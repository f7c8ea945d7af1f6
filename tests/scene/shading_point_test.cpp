// From hits to surfaces: attributes, sides, normals, emission.

#include "gi/scene/shading/shading_point.h"
#include "tests/support/scenes.h"

#include <gtest/gtest.h>

namespace gi::test {
namespace {

/// One triangle in the plane z = 0, front towards +z, uv = xy.
Mesh triangle()
{
    Mesh mesh;
    mesh.material = 0;
    mesh.positions = {{0, 0, 0}, {2, 0, 0}, {0, 1, 0}};
    mesh.triangles = {{0, 1, 2}};
    return mesh;
}

World world_with(Mesh const& mesh, Material const& material, std::vector<Rgba8> const& texels = {})
{
    Scene scene;
    add_material(scene, material);
    scene.meshes = {mesh};
    Node node;
    node.meshes = {0};
    scene.nodes = {node};
    if (!texels.empty()) {
        scene.textures.texels = texels;
        Texture texture;
        texture.width = std::uint32_t(texels.size());
        texture.height = 1;
        texture.nearest = true;
        scene.textures.textures = {texture};
    }
    return world_of(scene);
}

ShadingPoint shade(World const& world, vec2 barycentric, vec3 direction)
{
    return shading_point(view(world), 0, barycentric, glm::normalize(direction));
}

void expect_near(vec3 a, vec3 b, char const* what = "")
{
    EXPECT_NEAR(glm::distance(a, b), 0, 1e-5)
        << what << ": " << a.x << " " << a.y << " " << a.z << " for " << b.x << " " << b.y << " " << b.z;
}

TEST(ShadingPoint, BarycentricsWeighVerticesOneAndTwo)
{
    Mesh mesh = triangle();
    mesh.colors = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    World const world = world_with(mesh, lambert(vec3{0.5f}));
    ShadingPoint const at = shade(world, {0.25f, 0.5f}, {0, 0, -1});
    expect_near(at.position, {0.5f, 0.5f, 0});
    expect_near(at.bsdf.diffuse, {0.125f, 0.125f, 0.25f}, "colours multiply");
}

TEST(ShadingPoint, BothSidesFaceTheirViewer)
{
    World const world = world_with(triangle(), lambert(vec3{0.5f}));
    for (float const side : {1.0f, -1.0f}) {
        ShadingPoint const at = shade(world, {0.2f, 0.2f}, {0.3f, 0.2f, -side});
        EXPECT_EQ(at.front, side > 0);
        expect_near(at.geometric_normal, {0, 0, side});
        expect_near(at.frame.normal, {0, 0, side});
        expect_near(at.bsdf.diffuse, vec3{0.5f}, "no back-face culling");
    }
}

TEST(ShadingPoint, SmoothNormalsAreInterpolatedFlatOnesAreNot)
{
    Mesh mesh = triangle();
    mesh.normals = {{0, 0, 1}, {0.6f, 0, 0.8f}, {0, 0, 1}};
    World const world = world_with(mesh, lambert(vec3{0.5f}));
    vec3 const expected = glm::normalize(vec3{0.3f, 0, 0.9f});
    expect_near(shade(world, {0.5f, 0.25f}, {0, 0, -1}).frame.normal, expected);
    expect_near(shade(world, {0.5f, 0.25f}, {0, 0, 1}).frame.normal, -expected, "from behind");
    expect_near(shade(world, {0.5f, 0.25f}, {0, 0, -1}).geometric_normal, {0, 0, 1});
    mesh.normals.assign(3, vec3{0});
    expect_near(shade(world_with(mesh, lambert(vec3{0.5f})), {0.5f, 0.25f}, {0, 0, -1}).frame.normal, {0, 0, 1});
}

TEST(ShadingPoint, NormalsThatLookAwayAreBentToTheViewer)
{
    Mesh mesh = triangle();
    mesh.normals.assign(3, glm::normalize(vec3{1, 0, 0.2f}));
    World const world = world_with(mesh, lambert(vec3{0.5f}));
    for (vec3 const direction : {vec3{1, 0, -0.1f}, vec3{0, 0, -1}, vec3{-1, 0, -0.001f}, vec3{1, 0, 0.1f}}) {
        vec3 const towards = glm::normalize(direction);
        ShadingPoint const at = shade(world, {0.3f, 0.3f}, direction);
        EXPECT_GT(glm::dot(at.frame.normal, -towards), 0) << direction.x << " " << direction.z;
        EXPECT_NEAR(glm::length(at.frame.normal), 1, 1e-5);
    }
}

/// glTF: +X right (along u), +Y up (against v, which points down the image), +Z towards the viewer.
TEST(ShadingPoint, NormalMapsWorkWithoutTangents)
{
    Mesh mesh = triangle();
    Material m = lambert(vec3{0.5f});
    m.normal_map.texture = 0;
    std::vector<Rgba8> const leans_right{{230, 128, 200, 255}}, leans_up{{128, 230, 200, 255}};
    float const x = 230 / 127.5f - 1, z = 200 / 127.5f - 1, rest = 128 / 127.5f - 1;
    vec3 const right = glm::normalize(vec3{x, rest, z}), up = glm::normalize(vec3{rest, x, z});

    mesh.uv0 = {{0, 1}, {1, 1}, {0, 0}}; // the image upright: u to +x, v to -y
    expect_near(shade(world_with(mesh, m, leans_right), {0.3f, 0.3f}, {0, 0, -1}).frame.normal, right, "u to +x");
    expect_near(shade(world_with(mesh, m, leans_up), {0.3f, 0.3f}, {0, 0, -1}).frame.normal, up, "v to -y");
    expect_near(shade(world_with(mesh, m, leans_up), {0.3f, 0.3f}, {0, 0, 1}).frame.normal, -up, "from behind");

    mesh.uv0 = {{1, 1}, {0, 1}, {1, 0}}; // mirrored: u to -x
    expect_near(shade(world_with(mesh, m, leans_right), {0.3f, 0.3f}, {0, 0, -1}).frame.normal,
                glm::normalize(vec3{-x, rest, z}), "u to -x");
    expect_near(shade(world_with(mesh, m, leans_up), {0.3f, 0.3f}, {0, 0, -1}).frame.normal,
                glm::normalize(vec3{-rest, x, z}), "u to -x, v to -y");

    mesh.uv0 = {{0, 1}, {0, 0}, {1, 1}}; // turned: u to +y, v to -x
    expect_near(shade(world_with(mesh, m, leans_right), {0.3f, 0.3f}, {0, 0, -1}).frame.normal,
                glm::normalize(vec3{rest, x, z}), "u to +y");

    mesh.uv0.assign(3, vec2{0.5f});
    expect_near(shade(world_with(mesh, m, leans_up), {0.3f, 0.3f}, {0, 0, -1}).frame.normal, {0, 0, 1},
                "no plane");
}

TEST(ShadingPoint, GivenTangentsDecide)
{
    Mesh mesh = triangle();
    mesh.uv0 = {{0, 1}, {1, 1}, {0, 0}};
    Material m = lambert(vec3{0.5f});
    m.normal_map.texture = 0;
    m.normal_scale = 0.5f;
    float const x = 0.5f * (230 / 127.5f - 1), y = 0.5f * (180 / 127.5f - 1), z = 200 / 127.5f - 1;
    for (float const handedness : {1.0f, -1.0f}) {
        mesh.tangents.assign(3, vec4{0, 1, 0, handedness});
        // Bitangent = cross(normal, tangent) * w = (-w, 0, 0).
        expect_near(shade(world_with(mesh, m, {{230, 180, 200, 255}}), {0.3f, 0.3f}, {0, 0, -1}).frame.normal,
                    glm::normalize(vec3{-handedness * y, x, z}));
    }
}

TEST(ShadingPoint, EmissionLeavesTheFrontUnlessDoubleSided)
{
    for (bool const double_sided : {false, true}) {
        World const world = world_with(triangle(), emitter({1, 2, 3}, double_sided));
        EXPECT_EQ(shade(world, {0.2f, 0.2f}, {0, 0, -1}).emission, (vec3{1, 2, 3}));
        EXPECT_EQ(shade(world, {0.2f, 0.2f}, {0, 0, 1}).emission, double_sided ? (vec3{1, 2, 3}) : vec3{0});
    }
    EXPECT_EQ(shade(world_with(triangle(), lambert(vec3{1})), {0.2f, 0.2f}, {0, 0, -1}).emission, vec3{0});
}

TEST(ShadingPoint, MapsMultiplyTheirFactors)
{
    Mesh mesh = triangle();
    mesh.uv0.assign(3, vec2{0.5f});
    Material m;
    m.base_color = {0.5f, 1, 1};
    m.metallic = 0.8f;
    m.roughness = 0.9f;
    m.emission = vec3{10};
    m.base_color_map.texture = m.metallic_roughness_map.texture = m.emissive_map.texture = 0;
    // Bytes for sRGB 0.2, 0.4, 0.8.
    ShadingPoint const at = shade(world_with(mesh, m, {{51, 102, 204, 255}}), {0.2f, 0.2f}, {0, 0, -1});
    EXPECT_NEAR(at.bsdf.alpha, 0.36 * 0.36, 1e-5) << "roughness: green";
    float const metallic = 0.8f * 0.8f; // blue
    expect_near(at.bsdf.diffuse, (1 - metallic) * vec3{0.1f, 0.4f, 0.8f});
    expect_near(at.emission, {2, 4, 8});
}

TEST(ShadingPoint, CoverageIsBinaryForMasks)
{
    Mesh mesh = triangle();
    mesh.uv0.assign(3, vec2{0.5f});
    Material m = lambert(vec3{1});
    m.base_color_map.texture = 0;
    m.alpha = 0.8f;
    auto const covered = [&](AlphaMode mode, float cutoff) {
        m.alpha_mode = mode;
        m.alpha_cutoff = cutoff;
        return coverage(view(world_with(mesh, m, {{255, 255, 255, 102}})), 0, {0.2f, 0.2f}); // 0.8 * 0.4
    };
    EXPECT_EQ(covered(AlphaMode::opaque, 0.5f), 1);
    EXPECT_EQ(covered(AlphaMode::mask, 0.31f), 1);
    EXPECT_EQ(covered(AlphaMode::mask, 0.33f), 0);
    EXPECT_NEAR(covered(AlphaMode::blend, 0.5f), 0.32, 1e-5);
}

/// glTF 2, sec. 3.7.2.1: COLOR_0 multiplies the base colour, its alpha the alpha.
TEST(ShadingPoint, AlphasOfVerticesMultiplyThatOfTheMaterial)
{
    Mesh mesh = triangle();
    mesh.uv0.assign(3, vec2{0.5f});
    mesh.alphas = {1, 0.5f, 0.25f};
    Material m = lambert(vec3{1});
    m.base_color_map.texture = 0;
    m.alpha = 0.8f;
    auto const covered = [&](AlphaMode mode, vec2 at) {
        m.alpha_mode = mode;
        m.alpha_cutoff = 0.25f;
        return coverage(view(world_with(mesh, m, {{255, 255, 255, 102}})), 0, at);
    };
    EXPECT_EQ(covered(AlphaMode::opaque, {1, 0}), 1);
    EXPECT_NEAR(covered(AlphaMode::blend, {0, 0}), 0.8 * 0.4, 1e-5);
    EXPECT_NEAR(covered(AlphaMode::blend, {0.2f, 0.4f}), 0.8 * 0.4 * (0.4 * 1 + 0.2 * 0.5 + 0.4 * 0.25), 1e-5);
    EXPECT_EQ(covered(AlphaMode::mask, {0, 0}), 1);
    EXPECT_EQ(covered(AlphaMode::mask, {1, 0}), 0);
}

} // namespace
} // namespace gi::test
