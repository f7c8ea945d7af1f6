// EXT_meshopt_compression: what meshoptimizer encodes comes back, damaged data are refused.

#include "gi/core/error.h"
#include "tests/scene/gltf_builder.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <meshoptimizer.h>
#include <random>

namespace gi::test {
namespace {

constexpr std::size_t kSide = 20, kVertices = kSide * kSide;

std::vector<float> grid_positions()
{
    std::vector<float> p;
    for (std::size_t i = 0; i < kVertices; ++i) {
        p.push_back(float(i % kSide));
        p.push_back(std::sin(0.1f * float(i)));
        p.push_back(float(i / kSide));
        p.push_back(1); // a stride of 16, as the codec has blocks of four bytes
    }
    return p;
}
std::vector<std::uint32_t> grid_indices()
{
    std::vector<std::uint32_t> t;
    for (std::uint32_t y = 0; y + 1 < kSide; ++y)
        for (std::uint32_t x = 0; x + 1 < kSide; ++x) {
            std::uint32_t const i = y * kSide + x;
            t.insert(t.end(), {i, i + std::uint32_t(kSide), i + 1, i + 1, i + std::uint32_t(kSide),
                               i + std::uint32_t(kSide) + 1});
        }
    return t;
}

/// A view of compressed bytes in buffer 0 that stands for count * stride bytes of the fallback buffer 1.
int add_compressed(GltfBuilder& b, std::vector<unsigned char> const& data, std::size_t count, std::size_t stride,
                   char const* mode, char const* filter = "NONE")
{
    int const view = b.add_view(data);
    nlohmann::json& v = b.root["bufferViews"][std::size_t(view)];
    nlohmann::json const packed{{"buffer", 0},
                                {"byteOffset", v["byteOffset"]},
                                {"byteLength", data.size()},
                                {"byteStride", stride},
                                {"count", count},
                                {"mode", mode},
                                {"filter", filter}};
    v = {{"buffer", 1}, {"byteLength", count * stride}, {"extensions", {{"EXT_meshopt_compression", packed}}}};
    if (stride >= 4 && std::string(mode) == "ATTRIBUTES") v["byteStride"] = stride;
    return view;
}
void finish(GltfBuilder& b)
{
    b.root["buffers"] = {
        {{"byteLength", b.binary.size()}},
        {{"byteLength", 1000000}, {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}}};
    b.root["extensionsUsed"] = b.root["extensionsRequired"] = {"EXT_meshopt_compression"};
}

std::vector<unsigned char> encode_vertices(void const* data, std::size_t count, std::size_t stride)
{
    std::vector<unsigned char> out(meshopt_encodeVertexBufferBound(count, stride));
    out.resize(meshopt_encodeVertexBuffer(out.data(), out.size(), data, count, stride));
    return out;
}
std::vector<unsigned char> encode_triangles(std::vector<std::uint32_t> const& indices)
{
    std::vector<unsigned char> out(meshopt_encodeIndexBufferBound(indices.size(), kVertices));
    out.resize(meshopt_encodeIndexBuffer(out.data(), out.size(), indices.data(), indices.size()));
    return out;
}

GltfBuilder grid()
{
    GltfBuilder b;
    int const positions = b.add_accessor(
        add_compressed(b, encode_vertices(grid_positions().data(), kVertices, 16), kVertices, 16, "ATTRIBUTES"),
        kFloat, kVertices, "VEC3");
    std::vector<std::uint32_t> const indices = grid_indices();
    int const triangles =
        b.add_accessor(add_compressed(b, encode_triangles(indices), indices.size(), 4, "TRIANGLES"), kUint,
                       indices.size(), "SCALAR");
    b.add_primitive({{"POSITION", positions}})["indices"] = triangles;
    return b;
}

TEST(Meshopt, AttributesAndTrianglesComeBack)
{
    GltfBuilder b = grid();
    finish(b);
    Scene const scene = b.parse();
    Mesh const& mesh = scene.meshes.at(0);
    std::vector<float> const p = grid_positions();
    ASSERT_EQ(mesh.positions.size(), kVertices);
    for (std::size_t i = 0; i < kVertices; ++i)
        EXPECT_EQ(mesh.positions[i], (vec3{p[4 * i], p[4 * i + 1], p[4 * i + 2]}));
    std::vector<std::uint32_t> const indices = grid_indices();
    ASSERT_EQ(3 * mesh.triangles.size(), indices.size());
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) { // the codec may rotate a triangle
        uvec3 const got = mesh.triangles[t];
        int first = 0;
        while (first < 2 && got[first] != indices[3 * t]) ++first;
        for (int k = 0; k < 3; ++k) EXPECT_EQ(got[(first + k) % 3], indices[3 * t + std::size_t(k)]);
    }
}

TEST(Meshopt, IndexSequencesComeBack)
{
    GltfBuilder b;
    int const positions = b.add_floats({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0}, "VEC3", 3);
    std::vector<std::uint32_t> const indices{0, 1, 2, 3};
    std::vector<unsigned char> data(meshopt_encodeIndexSequenceBound(4, 4));
    data.resize(meshopt_encodeIndexSequence(data.data(), data.size(), indices.data(), 4));
    int const strip = b.add_accessor(add_compressed(b, data, 4, 2, "INDICES"), kUshort, 4, "SCALAR");
    nlohmann::json& p = b.add_primitive({{"POSITION", positions}});
    p["indices"] = strip;
    p["mode"] = 5;
    finish(b);
    EXPECT_EQ(b.parse().meshes.at(0).triangles, (std::vector<uvec3>{{0, 1, 2}, {2, 1, 3}}));
}

TEST(Meshopt, OctahedralAndExponentialFiltersAreUndone)
{
    std::mt19937 random(3);
    std::normal_distribution<float> normal;
    std::vector<float> directions, values;
    for (std::size_t i = 0; i < kVertices; ++i) {
        vec3 const n = glm::normalize(vec3{normal(random), normal(random), normal(random)});
        directions.insert(directions.end(), {n.x, n.y, n.z, 0});
        values.insert(values.end(), {normal(random), 100 * normal(random), 1e-3f * normal(random)});
    }
    std::vector<std::int8_t> packed_directions(4 * kVertices);
    meshopt_encodeFilterOct(packed_directions.data(), kVertices, 4, 8, directions.data());
    std::vector<std::uint32_t> packed_values(3 * kVertices);
    // Signed mantissas of 16 bits with exponents above them (the library's own encoder changed with version 0.19).
    std::transform(values.begin(), values.end(), packed_values.begin(), [](float value) {
        int exponent = 0;
        long const mantissa = std::lround(std::ldexp(std::frexp(value, &exponent), 15));
        return std::uint32_t(exponent - 15) << 24 | (std::uint32_t(mantissa) & 0xffffffu);
    });

    GltfBuilder b;
    int const positions = b.add_accessor(add_compressed(b, encode_vertices(packed_values.data(), kVertices, 12),
                                                        kVertices, 12, "ATTRIBUTES", "EXPONENTIAL"),
                                         kFloat, kVertices, "VEC3");
    int const normals = b.add_accessor(add_compressed(b, encode_vertices(packed_directions.data(), kVertices, 4),
                                                      kVertices, 4, "ATTRIBUTES", "OCTAHEDRAL"),
                                       kByte, kVertices, "VEC3", true);
    b.add_primitive({{"POSITION", positions}, {"NORMAL", normals}});
    finish(b);
    Scene const scene = b.parse();
    Mesh const& mesh = scene.meshes.at(0);
    for (std::size_t i = 0; i < kVertices; ++i) {
        vec3 const p{values[3 * i], values[3 * i + 1], values[3 * i + 2]};
        EXPECT_LT(glm::distance(mesh.positions[i], p), 1e-4f * glm::length(p));
        vec3 const n{directions[4 * i], directions[4 * i + 1], directions[4 * i + 2]};
        EXPECT_GT(glm::dot(mesh.normals[i], n), 0.9995f);
    }
}

TEST(Meshopt, QuaternionFilterIsUndone)
{
    std::mt19937 random(4);
    std::normal_distribution<float> normal;
    constexpr std::size_t kKeys = 50;
    std::vector<float> turns, times;
    for (std::size_t i = 0; i < kKeys; ++i) {
        vec4 const q = glm::normalize(vec4{normal(random), normal(random), normal(random), normal(random)});
        turns.insert(turns.end(), {q.x, q.y, q.z, q.w});
        times.push_back(float(i));
    }
    std::vector<std::int16_t> packed(4 * kKeys);
    meshopt_encodeFilterQuat(packed.data(), kKeys, 8, 16, turns.data());
    GltfBuilder b;
    b.add_triangle();
    int const input = b.add_floats(times, "SCALAR", 1);
    int const output = b.add_accessor(
        add_compressed(b, encode_vertices(packed.data(), kKeys, 8), kKeys, 8, "ATTRIBUTES", "QUATERNION"), kShort,
        kKeys, "VEC4", true);
    b.append("animations", {{"samplers", {{{"input", input}, {"output", output}}}},
                            {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "rotation"}}}}}}});
    finish(b);
    Scene const scene = b.parse();
    std::vector<float> const& got = scene.animations.at(0).channels.at(0).values;
    ASSERT_EQ(got.size(), turns.size());
    for (std::size_t i = 0; i < kKeys; ++i) {
        float d = 0;
        for (std::size_t c = 0; c < 4; ++c) d += got[4 * i + c] * turns[4 * i + c];
        EXPECT_GT(std::abs(d), 0.9999f); // q and -q are one rotation
    }
}

TEST(Meshopt, DamagedDataAreRefused)
{
    GltfBuilder whole = grid();
    finish(whole);
    nlohmann::json const packed = whole.root["bufferViews"][0]["extensions"]["EXT_meshopt_compression"];
    auto const with = [&](char const* key, nlohmann::json const& value) {
        GltfBuilder b = whole;
        b.root["bufferViews"][0]["extensions"]["EXT_meshopt_compression"][key] = value;
        return b;
    };
    EXPECT_THROW(with("byteLength", int(packed["byteLength"]) / 2).parse(), InputError);
    EXPECT_THROW(with("byteLength", 1u << 30).parse(), InputError);
    EXPECT_THROW(with("count", std::uint64_t(1) << 40).parse(), InputError);
    EXPECT_THROW(with("count", 0).parse(), InputError);
    EXPECT_THROW(with("byteStride", 13).parse(), InputError);
    EXPECT_THROW(with("buffer", 7).parse(), InputError);
    EXPECT_THROW(with("mode", "NOISE").parse(), InputError);
    EXPECT_THROW(with("filter", "QUATERNION").parse(), InputError);
    std::mt19937 random(5);
    for (int i = 0; i < 500; ++i) {
        GltfBuilder b = whole;
        for (int k = 0; k < 4; ++k) b.binary[random() % b.binary.size()] = static_cast<unsigned char>(random());
        try {
            b.parse();
        } catch (InputError const&) {
        }
    }
}

} // namespace
} // namespace gi::test
