// KHR_draco_mesh_compression: what Draco encodes comes back, damaged data are refused.

#include "gi/core/error.h"
#include "tests/scene/gltf_builder.h"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wpedantic"
#pragma GCC diagnostic ignored "-Wextra"
#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#pragma GCC diagnostic pop
#include <algorithm>
#include <gtest/gtest.h>
#include <random>

namespace gi::test {
namespace {

constexpr int kRings = 12, kSectors = 24;

vec3 on_sphere(int ring, int sector)
{
    float const a = kPi * float(ring) / kRings, b = 2 * kPi * float(sector % kSectors) / kSectors;
    return {std::sin(a) * std::cos(b), std::cos(a), std::sin(a) * std::sin(b)};
}

std::vector<std::array<vec3, 3>> sphere()
{
    std::vector<std::array<vec3, 3>> out;
    for (int r = 0; r < kRings; ++r)
        for (int s = 0; s < kSectors; ++s) {
            vec3 const a = on_sphere(r, s), b = on_sphere(r + 1, s), c = on_sphere(r, s + 1),
                       d = on_sphere(r + 1, s + 1);
            if (r > 0) out.push_back({a, c, b});
            if (r + 1 < kRings) out.push_back({c, d, b});
        }
    return out;
}

/// A sphere with positions, normals (the positions) and 8-bit colours.
GltfBuilder packed_sphere(int method)
{
    auto const triangles = sphere();
    draco::TriangleSoupMeshBuilder soup;
    soup.Start(int(triangles.size()));
    int const position = soup.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
    int const normal = soup.AddAttribute(draco::GeometryAttribute::NORMAL, 3, draco::DT_FLOAT32);
    int const color = soup.AddAttribute(draco::GeometryAttribute::COLOR, 4, draco::DT_UINT8);
    std::array<std::uint8_t, 4> const orange{255, 51, 0, 255};
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        auto const& v = triangles[t];
        draco::FaceIndex const face{std::uint32_t(t)};
        soup.SetAttributeValuesForFace(position, face, &v[0], &v[1], &v[2]);
        soup.SetAttributeValuesForFace(normal, face, &v[0], &v[1], &v[2]);
        soup.SetAttributeValuesForFace(color, face, orange.data(), orange.data(), orange.data());
    }
    std::unique_ptr<draco::Mesh> const mesh = soup.Finalize();
    draco::Encoder encoder;
    encoder.SetEncodingMethod(method);
    encoder.SetAttributeQuantization(draco::GeometryAttribute::POSITION, 14);
    encoder.SetAttributeQuantization(draco::GeometryAttribute::NORMAL, 10);
    draco::EncoderBuffer buffer;
    EXPECT_TRUE(encoder.EncodeMeshToBuffer(*mesh, &buffer).ok());

    GltfBuilder b;
    int const view = b.add_view(std::vector<char>(buffer.data(), buffer.data() + buffer.size()));
    std::size_t const points = mesh->num_points();
    nlohmann::json const attributes{{"POSITION", b.add_accessor(-1, kFloat, points, "VEC3")},
                                    {"NORMAL", b.add_accessor(-1, kFloat, points, "VEC3")},
                                    {"COLOR_0", b.add_accessor(-1, kUbyte, points, "VEC4", true)}};
    int const indices = b.add_accessor(-1, kUshort, 3 * triangles.size(), "SCALAR");
    nlohmann::json& p = b.add_primitive(attributes);
    p["indices"] = indices;
    p["extensions"]["KHR_draco_mesh_compression"] = {{"bufferView", view},
                                                     {"attributes",
                                                      {{"POSITION", mesh->attribute(position)->unique_id()},
                                                       {"NORMAL", mesh->attribute(normal)->unique_id()},
                                                       {"COLOR_0", mesh->attribute(color)->unique_id()}}}};
    b.root["extensionsUsed"] = b.root["extensionsRequired"] = {"KHR_draco_mesh_compression"};
    return b;
}

TEST(Draco, SphereComesBack)
{
    for (int const method : {draco::MESH_SEQUENTIAL_ENCODING, draco::MESH_EDGEBREAKER_ENCODING}) {
        Scene const scene = packed_sphere(method).parse();
        Mesh const& mesh = scene.meshes.at(0);
        EXPECT_EQ(mesh.triangles.size(), sphere().size());
        ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
        ASSERT_EQ(mesh.colors.size(), mesh.positions.size());
        double area = 0;
        for (uvec3 const t : mesh.triangles) {
            vec3 const a = mesh.positions[t.x], b = mesh.positions[t.y], c = mesh.positions[t.z];
            vec3 const n = glm::cross(b - a, c - a);
            EXPECT_GT(glm::dot(n, a + b + c), 0); // faces outwards, as it was encoded
            area += 0.5 * double(glm::length(n));
        }
        double expected = 0;
        for (auto const& t : sphere()) expected += 0.5 * double(glm::length(glm::cross(t[1] - t[0], t[2] - t[0])));
        EXPECT_NEAR(area, expected, 2e-3 * expected);
        for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
            EXPECT_NEAR(glm::length(mesh.positions[i]), 1, 1e-3);
            EXPECT_GT(glm::dot(mesh.positions[i], mesh.normals[i]), 0.999f);
            EXPECT_LT(glm::distance(mesh.colors[i], vec3(1, 0.2f, 0)), 1e-5f);
        }
    }
}

TEST(Draco, DamagedDataAreRefused)
{
    for (int const method : {draco::MESH_SEQUENTIAL_ENCODING, draco::MESH_EDGEBREAKER_ENCODING}) {
        GltfBuilder const whole = packed_sphere(method);
        std::size_t const length = whole.root["bufferViews"][0]["byteLength"];
        for (std::size_t n = 1; n < length; n += 64) {
            GltfBuilder b = whole;
            b.root["bufferViews"][0]["byteLength"] = n;
            EXPECT_THROW(b.parse(), InputError) << n;
        }
        GltfBuilder b = whole;
        b.root["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"]["attributes"]
              ["POSITION"] = 77;
        EXPECT_THROW(b.parse(), InputError);
    }
}

} // namespace
} // namespace gi::test
