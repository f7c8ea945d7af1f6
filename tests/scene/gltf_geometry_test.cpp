// Vertices and triangles out of glTF: every way in which the format can store them.

#include "gi/core/error.h"
#include "gi/scene/model/world.h"
#include "tests/scene/gltf_builder.h"

#include <gtest/gtest.h>

namespace gi::test {
namespace {

std::vector<float> const kSquare{0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0};

/// Triangles of a primitive on the four corners of a square.
std::vector<uvec3> square_triangles(int mode, int component, std::vector<std::uint32_t> const& indices)
{
    GltfBuilder b;
    int const positions = b.add_floats(kSquare, "VEC3", 3);
    int view = -1;
    if (component == kUbyte) view = b.add_view(std::vector<std::uint8_t>(indices.begin(), indices.end()));
    if (component == kUshort) view = b.add_view(std::vector<std::uint16_t>(indices.begin(), indices.end()));
    if (component == kUint) view = b.add_view(indices);
    int const accessor = b.add_accessor(view, component, indices.size(), "SCALAR");
    nlohmann::json& p = b.add_primitive({{"POSITION", positions}});
    p["indices"] = accessor;
    p["mode"] = mode;
    return b.parse().meshes.at(0).triangles;
}

TEST(GltfGeometry, IndicesOfAllTypesMakeTriangles)
{
    std::vector<uvec3> const expected{{0, 1, 2}, {2, 1, 3}};
    for (int const component : {kUbyte, kUshort, kUint})
        EXPECT_EQ(square_triangles(4, component, {0, 1, 2, 2, 1, 3}), expected) << component;
}

TEST(GltfGeometry, StripsAndFansKeepTheirWinding)
{
    EXPECT_EQ(square_triangles(5, kUshort, {0, 1, 2, 3}), (std::vector<uvec3>{{0, 1, 2}, {2, 1, 3}}));
    EXPECT_EQ(square_triangles(6, kUshort, {0, 1, 3, 2}), (std::vector<uvec3>{{0, 1, 3}, {0, 3, 2}}));
}

TEST(GltfGeometry, UnindexedVerticesMakeTrianglesInOrder)
{
    GltfBuilder b;
    b.add_triangle();
    Scene const scene = b.parse();
    ASSERT_EQ(scene.meshes.size(), 1u);
    EXPECT_EQ(scene.meshes[0].triangles, (std::vector<uvec3>{{0, 1, 2}}));
    EXPECT_EQ(scene.meshes[0].positions, (std::vector<vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
}

TEST(GltfGeometry, PointsAndLinesAreCountedAsLost)
{
    GltfBuilder b;
    b.add_triangle();
    b.add_triangle()["mode"] = 0;
    b.add_triangle()["mode"] = 3;
    Report report;
    EXPECT_EQ(b.parse(report).meshes.size(), 1u);
    EXPECT_EQ(lost(report, "points and lines skipped"), 2u);
}

TEST(GltfGeometry, SparseValuesReplaceThoseOfTheBufferView)
{
    GltfBuilder b;
    nlohmann::json& p = b.add_triangle();
    int const positions = p["attributes"]["POSITION"];
    int const where = b.add_view(std::vector<std::uint16_t>{2});
    int const values = b.add_view(std::vector<float>{7, 8, 9});
    b.root["accessors"][std::size_t(positions)]["sparse"] = {
        {"count", 1},
        {"indices", {{"bufferView", where}, {"componentType", kUshort}}},
        {"values", {{"bufferView", values}}}};
    EXPECT_EQ(b.parse().meshes[0].positions, (std::vector<vec3>{{0, 0, 0}, {1, 0, 0}, {7, 8, 9}}));
}

TEST(GltfGeometry, SparseValuesWithoutABufferViewStandAmongZeros)
{
    GltfBuilder b;
    int const where = b.add_view(std::vector<std::uint8_t>{1, 2});
    int const values = b.add_view(std::vector<float>{1, 0, 0, 0, 1, 0});
    int const accessor = b.add_accessor(-1, kFloat, 3, "VEC3");
    b.root["accessors"][std::size_t(accessor)]["sparse"] = {
        {"count", 2},
        {"indices", {{"bufferView", where}, {"componentType", kUbyte}}},
        {"values", {{"bufferView", values}}}};
    b.add_primitive({{"POSITION", accessor}});
    EXPECT_EQ(b.parse().meshes[0].positions, (std::vector<vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
}

TEST(GltfGeometry, QuantizedAttributesAreNormalized)
{
    GltfBuilder b;
    int const positions =
        b.add_accessor(b.add_view(std::vector<std::int16_t>{0, 0, 0, 0, 32767, 0, 0, 0, 0, -32768, 0, 0}, 8),
                       kShort, 3, "VEC3", true);
    int const normals =
        b.add_accessor(b.add_view(std::vector<std::int8_t>{0, 0, 127, 0, 0, 0, 127, 0, 0, 0, -127, 0}, 4), kByte,
                       3, "VEC3", true);
    int const uv =
        b.add_accessor(b.add_view(std::vector<std::uint16_t>{0, 0, 65535, 0, 0, 65535}), kUshort, 3, "VEC2", true);
    int const plain_uv = b.add_accessor(
        b.add_view(std::vector<std::uint8_t>{0, 0, 0, 0, 3, 0, 0, 0, 0, 200, 0, 0}, 4), kUbyte, 3, "VEC2");
    b.add_primitive({{"POSITION", positions}, {"NORMAL", normals}, {"TEXCOORD_0", uv}, {"TEXCOORD_1", plain_uv}});
    b.root["extensionsUsed"] = b.root["extensionsRequired"] = {"KHR_mesh_quantization"};
    Report report;
    Scene const scene = b.parse(report);
    Mesh const& mesh = scene.meshes.at(0);
    EXPECT_EQ(mesh.positions, (std::vector<vec3>{{0, 0, 0}, {1, 0, 0}, {0, -1, 0}}));
    EXPECT_EQ(mesh.normals, (std::vector<vec3>{{0, 0, 1}, {0, 0, 1}, {0, 0, -1}}));
    EXPECT_EQ(mesh.uv0, (std::vector<vec2>{{0, 0}, {1, 0}, {0, 1}}));
    EXPECT_EQ(mesh.uv1, (std::vector<vec2>{{0, 0}, {3, 0}, {0, 200}}));
    EXPECT_TRUE(report.losses().empty());
}

TEST(GltfGeometry, InterleavedAttributesFollowTheirStride)
{
    GltfBuilder b;
    int const view = b.add_view(std::vector<float>{0, 0, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 1, 0, 0, 0, 1}, 24);
    int const positions = b.add_accessor(view, kFloat, 3, "VEC3");
    int const normals = b.add_accessor(view, kFloat, 3, "VEC3");
    b.root["accessors"][std::size_t(normals)]["byteOffset"] = 12;
    b.add_primitive({{"POSITION", positions}, {"NORMAL", normals}});
    Scene const scene = b.parse();
    EXPECT_EQ(scene.meshes[0].positions, (std::vector<vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
    EXPECT_EQ(scene.meshes[0].normals, (std::vector<vec3>(3, {0, 0, 1})));
}

TEST(GltfGeometry, ColorsAndTangentsAreRead)
{
    GltfBuilder b;
    nlohmann::json& p = b.add_triangle();
    nlohmann::json attributes = p["attributes"];
    attributes["COLOR_0"] =
        b.add_accessor(b.add_view(std::vector<std::uint8_t>{255, 0, 0, 255, 0, 255, 0, 51, 0, 0, 255, 255}),
                       kUbyte, 3, "VEC4", true);
    attributes["NORMAL"] = b.add_floats({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3", 3);
    attributes["TANGENT"] = b.add_floats({2, 0, 0, 1, 1, 0, 0, -1, 0, 1, 0, 1}, "VEC4", 4);
    b.root["meshes"][0]["primitives"][0]["attributes"] = attributes;
    Report report;
    Scene const scene = b.parse(report);
    EXPECT_EQ(scene.meshes[0].colors, (std::vector<vec3>{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}));
    EXPECT_EQ(scene.meshes[0].tangents, (std::vector<vec4>{{1, 0, 0, 1}, {1, 0, 0, -1}, {0, 1, 0, 1}}));
    EXPECT_TRUE(scene.meshes[0].alphas.empty()); // its material is opaque
    EXPECT_TRUE(report.losses().empty());
}

/// COLOR_0 as it may be stored: floats, or bytes and shorts that are normalized, of three or four components.
TEST(GltfGeometry, AlphasOfVerticesAreThoseOfMasksAndBlending)
{
    struct Case {
        char const* mode; ///< null = no material
        int component;
        char const* type;
        std::vector<float> alphas;
    };
    std::vector<float> const read{0.2f, 1, 0.6f};
    for (auto const& [mode, component, type, alphas] : std::vector<Case>{{nullptr, kFloat, "VEC4", {}},
                                                                         {"", kFloat, "VEC4", {}},
                                                                         {"OPAQUE", kUbyte, "VEC4", {}},
                                                                         {"OTHER", kFloat, "VEC4", {}},
                                                                         {"MASK", kFloat, "VEC4", read},
                                                                         {"MASK", kUbyte, "VEC4", read},
                                                                         {"BLEND", kUshort, "VEC4", read},
                                                                         {"BLEND", kFloat, "VEC4", read},
                                                                         {"BLEND", kFloat, "VEC3", {}},
                                                                         {"MASK", kUbyte, "VEC3", {}}}) {
        SCOPED_TRACE(std::string(mode ? mode : "none") + " " + type + " " + std::to_string(component));
        GltfBuilder b;
        std::vector<float> values;
        for (float const a : read) {
            values.insert(values.end(), {0, 0.4f, 1});
            if (type == std::string("VEC4")) values.push_back(a);
        }
        auto const view = [&](auto most) {
            std::vector<decltype(most)> stored;
            for (float const v : values) stored.push_back(decltype(most)(v * float(most) + 0.5f));
            return b.add_view(stored);
        };
        int const at = component == kFloat   ? b.add_view(values)
                       : component == kUbyte ? view(std::uint8_t{255})
                                             : view(std::uint16_t{65535});
        int const colors = b.add_accessor(at, component, 3, type, component != kFloat);
        nlohmann::json& p = b.add_triangle();
        p["attributes"]["COLOR_0"] = colors;
        p["attributes"]["COLOR_1"] = colors; // for programs that know it
        if (mode) {
            p["material"] = 0;
            b.append("materials", *mode ? nlohmann::json{{"alphaMode", mode}} : nlohmann::json::object());
        }
        Report report;
        Scene const scene = b.parse(report);
        Mesh const& mesh = scene.meshes[0];
        ASSERT_EQ(mesh.alphas.size(), alphas.size());
        for (std::size_t i = 0; i < alphas.size(); ++i) EXPECT_NEAR(mesh.alphas[i], alphas[i], 1e-5);
        for (vec3 const c : mesh.colors) EXPECT_LT(glm::distance(c, {0, 0.4f, 1}), 1e-5f);
        EXPECT_TRUE(report.losses().empty());
    }
}

TEST(GltfGeometry, ColoursThatChangeNothingAreLeftOut)
{
    GltfBuilder b;
    nlohmann::json& p = b.add_triangle();
    p["attributes"]["COLOR_0"] = b.add_floats({1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1}, "VEC4", 4);
    p["material"] = 0;
    b.append("materials", {{"alphaMode", "BLEND"}});
    Scene const scene = b.parse();
    EXPECT_TRUE(scene.meshes[0].alphas.empty());
    EXPECT_TRUE(scene.meshes[0].colors.empty());
    Report report;
    EXPECT_TRUE(build_world(std::make_shared<Scene const>(scene), 0.0, report).alphas.empty());
}

TEST(GltfGeometry, AlphasOutOfRangeAreClampedAndCounted)
{
    GltfBuilder b;
    nlohmann::json& p = b.add_triangle();
    p["attributes"]["COLOR_0"] = b.add_floats({1, 1, 1, -1, 1, 1, 1, 2, 1, 1, 1, 0.5f}, "VEC4", 4);
    p["material"] = 0;
    b.append("materials", {{"alphaMode", "BLEND"}});
    Report report;
    EXPECT_EQ(b.parse(report).meshes[0].alphas, (std::vector<float>{0, 1, 0.5f}));
    EXPECT_EQ(lost(report, "vertex colours not within 0..1, clamped"), 2u);
}

/// Sec. 3.7.2.1: without normals, given tangents MUST be ignored. Coordinates that no texture uses are nobody's loss.
TEST(GltfGeometry, WhatTheSpecificationIgnoresIsIgnoredWithoutAWord)
{
    GltfBuilder b;
    int const tangents = b.add_floats({1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1}, "VEC4", 4),
              uv = b.add_floats({0, 0, 1, 0, 0, 1}, "VEC2", 2);
    nlohmann::json& p = b.add_triangle();
    p["attributes"]["TANGENT"] = tangents;
    p["attributes"]["TEXCOORD_2"] = uv;
    p["attributes"]["_MINE"] = uv;
    p["extras"] = {{"mine", 1}};
    Report report;
    EXPECT_TRUE(b.parse(report).meshes[0].tangents.empty());
    EXPECT_TRUE(report.losses().empty());
}

TEST(GltfGeometry, NormalsAreMadeUnitAndCounted)
{
    GltfBuilder b;
    int const normals = b.add_floats({0, 0, 3, 0, 0, 0, 0, 0, 1}, "VEC3", 3);
    b.add_triangle()["attributes"]["NORMAL"] = normals;
    Report report;
    EXPECT_EQ(b.parse(report).meshes[0].normals, (std::vector<vec3>{{0, 0, 1}, {0, 0, 0}, {0, 0, 1}}));
    EXPECT_EQ(lost(report, "normals that are not unit, normalised or left flat"), 2u);
}

TEST(GltfGeometry, PrimitivesThatShareVerticesKeepOnlyTheirOwn)
{
    constexpr std::size_t kTriangles = 20;
    GltfBuilder b;
    std::vector<float> positions;
    for (std::size_t i = 0; i < 9 * kTriangles; ++i) positions.push_back(float(i));
    int const shared = b.add_floats(positions, "VEC3", 3);
    for (std::uint32_t t = 0; t < kTriangles; ++t) {
        int const indices = b.add_accessor(b.add_view(std::vector<std::uint32_t>{3 * t + 2, 3 * t + 1, 3 * t}),
                                           kUint, 3, "SCALAR");
        b.add_primitive({{"POSITION", shared}})["indices"] = indices;
    }
    Scene const scene = b.parse();
    ASSERT_EQ(scene.meshes.size(), kTriangles);
    for (std::size_t t = 0; t < kTriangles; ++t) {
        Mesh const& mesh = scene.meshes[t];
        ASSERT_EQ(mesh.positions.size(), 3u);
        for (int k = 0; k < 3; ++k)
            EXPECT_EQ(mesh.positions[mesh.triangles[0][k]].x, positions[3 * (3 * t + std::size_t(2 - k))]);
    }
}

TEST(GltfGeometry, MorphedColoursAreNamedAsIgnored)
{
    GltfBuilder b;
    int const target = b.add_floats({0, 0, 1, 0, 0, 2, 0, 0, 3}, "VEC3", 3);
    b.add_triangle()["targets"] = {{{"POSITION", target}, {"COLOR_0", target}, {"_MINE", target}}};
    Report report;
    EXPECT_EQ(b.parse(report).meshes[0].morph_targets.size(), 1u);
    EXPECT_EQ(lost(report, "morph targets of colours and texture coordinates ignored"), 1u);
}

TEST(GltfGeometry, MorphTargetsAreDisplacements)
{
    GltfBuilder b;
    int const target = b.add_floats({0, 0, 1, 0, 0, 2, 0, 0, 3}, "VEC3", 3);
    b.add_triangle()["targets"] = {{{"POSITION", target}}, {{"NORMAL", target}}};
    b.root["meshes"][0]["weights"] = {0.25, 0.5};
    b.root["nodes"][0]["weights"] = {0.75, 1.0};
    Scene const scene = b.parse();
    ASSERT_EQ(scene.meshes[0].morph_targets.size(), 2u);
    EXPECT_EQ(scene.meshes[0].morph_targets[0].positions, (std::vector<vec3>{{0, 0, 1}, {0, 0, 2}, {0, 0, 3}}));
    EXPECT_TRUE(scene.meshes[0].morph_targets[0].normals.empty());
    EXPECT_EQ(scene.meshes[0].morph_targets[1].normals.size(), 3u);
    EXPECT_EQ(scene.nodes[0].morph_weights, (std::vector<float>{0.75f, 1.0f}));
}

} // namespace
} // namespace gi::test
