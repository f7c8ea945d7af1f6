// Light kept in cells of space: what was learnt is found, each side of a wall has its own, and lamps may change.

#include "gi/surfaces/light_cells.h"

#include <bit>
#include <glm/gtc/packing.hpp>
#include <gtest/gtest.h>
#include <unordered_set>

namespace gi::test {
namespace {

constexpr int kSide = 64;

Camera camera_at(dvec3 from, dvec3 to) { return look_at(from, to, 90); }

/// A plane z = const that a camera before or behind it sees.
LightPicture plane_seen(Camera const& camera, float z, vec3 light)
{
    LightPicture p;
    p.width = p.height = p.camera_width = p.camera_height = kSide;
    p.camera = camera;
    p.mean = light;
    p.texels.resize(std::size_t(kSide) * kSide);
    CameraRays const rays = camera_rays(camera, kSide, kSide, dvec3{0});
    vec3 const normal{0, 0, rays.origin.z > z ? 1.0f : -1.0f};
    for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x) {
            Ray const ray = rays.through({float(x) + 0.5f, float(y) + 0.5f});
            float const t = (z - ray.origin.z) / ray.direction.z;
            if (!(t > 0)) continue;
            vec3 const from = t * ray.direction;
            p.texels[std::size_t(y * kSide + x)] =
                light_texel(from, normal, light, 0, glm::dot(from, rays.forward));
        }
    return p;
}

/// In the cell of a level that contains a place; negative: it knows nothing.
vec3 found(LightCellTable const& table, vec3 at, int level, int side)
{
    glm::ivec3 const cell(glm::floor(at / std::ldexp(table.narrowest_m, level)));
    std::uint32_t const key = light_cell_key(cell, level, side);
    for (std::uint32_t b = 0; b < 3; ++b)
        for (LightCellTable::Cell const& c : table.buckets[(key / 2 + b) % LightCellTable::kBuckets])
            if ((c.key | 1u) == key) return glm::unpackF3x9_E1x5(c.light);
    return vec3{-1};
}

constexpr int kFront = 4, kBack = 5; // +z, -z

TEST(LightCells, KnowWhatPicturesShow)
{
    LightCells cells(20);
    vec3 const light{0.5f, 0.25f, 2};
    cells.learn(plane_seen(camera_at({0, 0, 3}, {0, 0, 0}), 0.2f, light), kSide * kSide, dvec3{0});
    auto const table = cells.table();
    EXPECT_EQ(table->left_out, 0u);
    EXPECT_FLOAT_EQ(table->narrowest_m, 0.15f);
    for (int level = 0; level < LightCellTable::kLevels; ++level) {
        vec3 const there = found(*table, {0.03f, 0.03f, 0.2f}, level, kFront);
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(there[c], light[c], 0.01f) << level;
        EXPECT_EQ(found(*table, {0.03f, 0.03f, 0.2f}, level, kBack), vec3{-1});
    }
}

TEST(LightCells, EachSideOfAThinWallHasItsOwn)
{
    LightCells cells(20);
    cells.learn(plane_seen(camera_at({0, 0, 3}, {0, 0, 0}), 0.05f, vec3{100}), kSide * kSide, dvec3{0});
    cells.learn(plane_seen(camera_at({0, 0, -3}, {0, 0, 0}), 0, vec3{0.5f}), kSide * kSide, dvec3{0});
    auto const table = cells.table();
    for (int level = 0; level < LightCellTable::kLevels; ++level) {
        EXPECT_NEAR(found(*table, {0.03f, 0.03f, 0}, level, kBack).x, 0.5f, 0.005f) << level;
        EXPECT_NEAR(found(*table, {0.03f, 0.03f, 0.05f}, level, kFront).x, 100, 1) << level;
    }
}

TEST(LightCells, OfOtherPlacesHaveOtherKeys)
{
    std::unordered_set<std::uint32_t> keys;
    double cells = 0;
    for (int level = 0; level < LightCellTable::kLevels; ++level)
        for (int side = 0; side < 6; ++side)
            for (int x = -20; x < 20; ++x)
                for (int y = -2; y < 20; ++y)
                    for (int z = -20; z < 20; ++z, ++cells) keys.insert(light_cell_key({x, y, z}, level, side));
    double const by_chance = cells * cells / 0x1p32; // of odd keys
    EXPECT_LT(cells - double(keys.size()), 1.5 * by_chance);
}

TEST(LightCells, FollowALampThatGoesOut)
{
    LightCells cells(20);
    Camera const camera = camera_at({0, 0, 3}, {0, 0, 0});
    for (int k = 0; k < 20; ++k) cells.learn(plane_seen(camera, 0, vec3{10}), kSide * kSide, dvec3{0});
    cells.doubt(0.01f);
    cells.learn(plane_seen(camera, 0, vec3{0.1f}), kSide * kSide, dvec3{0});
    cells.learn(plane_seen(camera, 0, vec3{0.1f}), kSide * kSide, dvec3{0});
    EXPECT_LT(found(*cells.table(), {0.03f, 0.03f, 0}, 1, kFront).x, 1);
}

TEST(LightCells, ForgetWhatIsFarBackAndKeepWithinTheirMemory)
{
    LightCells cells(1e4f);
    for (int k = 0; k < 60; ++k) {
        dvec3 const at(40.0 * k, 0, 3);
        cells.learn(plane_seen(camera_at(at, at - dvec3(0, 0, 3)), 0, vec3{1}), kSide * kSide, dvec3{0});
    }
    auto const table = cells.table();
    EXPECT_NEAR(found(*table, {40 * 59.0f, 0.03f, 0}, 2, kFront).x, 1, 0.01f);
    EXPECT_LT(table->left_out, 40u); // of about 40,000
}

TEST(LightCells, TinyAndFarPlacesAreLeftOutNotWrong)
{
    for (double const far : {1e-6, 1e9}) {
        LightCells cells{float(far)};
        cells.learn(plane_seen(camera_at(dvec3(0, 0, 3) * far, dvec3(0)), 0, vec3{1}), kSide * kSide, dvec3{0});
        EXPECT_NO_THROW(cells.table());
    }
    LightPicture broken = plane_seen(camera_at({0, 0, 3}, {0, 0, 0}), 0, vec3{1});
    for (LightTexel& t : broken.texels) t.depth_dark = std::bit_cast<std::uint32_t>(kInf) & ~7u;
    LightCells cells(20);
    cells.learn(broken, kSide * kSide, dvec3{0});
    auto const table = cells.table();
    EXPECT_TRUE(std::ranges::all_of(table->buckets, [](auto const& b) { return b[0].key == 0; }));
}

} // namespace
} // namespace gi::test
