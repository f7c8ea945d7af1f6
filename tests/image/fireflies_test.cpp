#include "gi/filter/fireflies.h"

#include "gi/core/error.h"
#include "gi/core/rng.h"
#include "gi/core/threads.h"

#include <algorithm>
#include <functional>
#include <gtest/gtest.h>

namespace gi::test {
namespace {

constexpr int kWallWidth = 40, kWallHeight = 32;

struct LitPoint {
    vec3 direct{1}, indirect{1}, albedo{0.5f}, normal{0, 0, 1};
};
using PointAt = std::function<LitPoint(int x, int y)>;

std::uint32_t wall_pixel(int x, int y) { return std::uint32_t(y * kWallWidth + x); }

/// A wall at z = 0, pixels 1 cm apart, with what `at` says of each pixel. Light is over the albedo.
Picture lit_wall(PointAt const& at)
{
    Picture p;
    p.width = kWallWidth;
    p.height = kWallHeight;
    for (char const* const name : {"color", "L0", "L1", "L2", "albedo", "normal", "position"}) p.add(name, 3);
    for (char const* const name : {"variance_direct", "variance_indirect"}) p.add(name, 1);
    for (int y = 0; y < kWallHeight; ++y)
        for (int x = 0; x < kWallWidth; ++x) {
            LitPoint const v = at(x, y);
            std::size_t const i = wall_pixel(x, y);
            auto const set = [&](char const* name, vec3 value) {
                for (int c = 0; c < 3; ++c) p.find(name)->data[3 * i + std::size_t(c)] = value[c];
            };
            set("L1", v.direct * v.albedo);
            set("L2", v.indirect * v.albedo);
            set("color", (v.direct + v.indirect) * v.albedo);
            set("albedo", v.albedo);
            set("normal", v.normal);
            set("position", 0.01f * vec3{float(x), float(y), 0});
            p.find("variance_direct")->data[i] = p.find("variance_indirect")->data[i] = 4;
        }
    return p;
}

/// Light between 0.5 and 1.5 of `level`.
vec3 noisy_light(float level, int x, int y, std::uint32_t seed = 0)
{
    return vec3{level * (0.5f + Pcg32::for_path(seed, wall_pixel(x, y), 0).uniform())};
}

std::vector<Firefly> fireflies_in(Picture const& p, FireflyCounts& counts) { return find_fireflies({&p}, counts); }

TEST(Fireflies, AreClampedToWhatTheirNeighbourhoodSupports)
{
    vec3 const red{300, 100, 50};
    auto const planted = [](int x, int y) {
        return (x == 10 && y == 8) || (x == 30 && y == 20) || (x == 31 && y == 20);
    };
    Picture p = lit_wall([&](int x, int y) {
        LitPoint v{noisy_light(1, x, y), noisy_light(1, x, y, 1)};
        if (planted(x, y)) v.indirect = red;
        return v;
    });
    FireflyCounts counts;
    std::vector<Firefly> const fireflies = fireflies_in(p, counts);
    ASSERT_EQ(fireflies.size(), 3u); // a pair too
    EXPECT_EQ(fireflies[0].pixel, wall_pixel(10, 8));
    EXPECT_EQ(counts.pixels, std::size_t(kWallWidth * kWallHeight));
    EXPECT_EQ(counts.clamped, 3u);
    EXPECT_EQ(counts.by_eye, 0u);
    auto const light = [&] {
        double sum = 0;
        for (std::size_t i = 0; i < p.pixels(); ++i) sum += double(luminance(rgb(*p.find("color"), i)));
        return sum;
    };
    double const before = light();
    EXPECT_NEAR(counts.light, before, 1e-5 * before);
    EXPECT_NEAR(counts.moved, 3 * 0.5 * double(luminance(red) - 2.4f), 3 * 0.5 * 0.8);
    clamp_fireflies(p, fireflies);
    EXPECT_NEAR(light(), before, 1e-5 * before); // spread, not lost
    float most = 0;
    for (std::size_t i = 0; i < p.pixels(); ++i) most = std::max(most, luminance(rgb(*p.find("L2"), i)));
    EXPECT_LT(most / 0.5f, 4.5f);
    EXPECT_LT(luminance(rgb(*p.find("L2"), wall_pixel(10, 25))) / 0.5f, 1.51f); // farther away
    for (Firefly const& f : fireflies) {
        vec3 const l1 = rgb(*p.find("L1"), f.pixel), l2 = rgb(*p.find("L2"), f.pixel);
        EXPECT_LT(luminance(l2) / 0.5f, 4.5f);
        EXPECT_GT(luminance(l2) / 0.5f, 2);
        EXPECT_GT(l2.x / l2.z, 2); // still of its hue
        EXPECT_EQ(f.direct, 1);
        for (int c = 0; c < 3; ++c) EXPECT_FLOAT_EQ(rgb(*p.find("color"), f.pixel)[c], l1[c] + l2[c]);
        EXPECT_EQ(p.find("variance_direct")->data[f.pixel], 4);
        EXPECT_FLOAT_EQ(p.find("variance_indirect")->data[f.pixel], 4 * f.indirect * f.indirect);
    }
    FireflyCounts after;
    EXPECT_TRUE(fireflies_in(p, after).empty());
}

TEST(Fireflies, AreNotSeenInTexturesShadowsLampsAndDarkness)
{
    auto const none = [](PointAt const& at) {
        Picture const p = lit_wall(at);
        FireflyCounts counts;
        return fireflies_in(p, counts).empty();
    };
    EXPECT_TRUE(none([](int x, int y) { // a texture with single bright texels
        return LitPoint{vec3{1}, vec3{1}, vec3{x % 7 == 3 && y % 7 == 3 ? 0.95f : 0.02f}};
    }));
    EXPECT_TRUE(none([](int x, int y) { // edges of shadows, and a small patch of sun
        return LitPoint{vec3{x < 13 || (x / 2 == 12 && y / 2 == 8) ? 50.0f : 0.0f}, vec3{0.1f}};
    }));
    EXPECT_TRUE(none([](int x, int) { // another surface
        return x == 20 ? LitPoint{vec3{50}, vec3{50}, vec3{0.5f}, vec3{1, 0, 0}} : LitPoint{};
    }));
    EXPECT_TRUE(none([](int x, int y) {
        return LitPoint{vec3{0}, vec3{x == 20 && y == 9 ? 9.0f : 0.0f}};
    }));                                // no light
    EXPECT_TRUE(none([](int x, int y) { // little beside the direct light
        return LitPoint{vec3{1}, vec3{x == 20 && y == 9 ? 0.9f : 0.0f}};
    }));
    EXPECT_TRUE(none([](int x, int y) { // black, and no surface at all
        return x < 20 ? LitPoint{vec3{x == 9 ? 100.0f : 1.0f}, vec3{1}, vec3{0}}
                      : LitPoint{vec3{y == 9 ? 100.0f : 1.0f}, vec3{1}, vec3{0.5f}, vec3{0}};
    }));
}

TEST(Fireflies, AreWhatOnlyOneEyeSees)
{
    // A bright patch that one neighbourhood supports: in the second picture, too, or only in the first.
    auto const patch = [](bool shows) {
        return lit_wall([=](int x, int y) {
            return LitPoint{vec3{1}, vec3{shows && x / 2 == 10 && y / 2 == 5 ? 40.0f : 1.0f}};
        });
    };
    Picture const left = patch(true), both = patch(true), right = patch(false);
    std::vector<std::uint32_t> same(left.pixels());
    for (std::size_t i = 0; i < same.size(); ++i) same[i] = i % kWallWidth < 3 ? kOwnLight : std::uint32_t(i) - 3;
    FireflyCounts counts;
    std::vector<Firefly> const held = find_fireflies({&left, {}, &right, same}, counts);
    ASSERT_EQ(held.size(), 4u);
    EXPECT_EQ(counts.by_eye, 4u);
    for (Firefly const& f : held) EXPECT_FLOAT_EQ(40 * f.indirect, 2);
    std::ranges::generate(same, [k = 0u]() mutable { return k++; });
    EXPECT_TRUE(find_fireflies({&left, {}, &both, same}, counts).empty());
    EXPECT_TRUE(find_fireflies({&right, {}, &left, same}, counts).empty());
    std::fill(same.begin(), same.end(), kOwnLight); // seen by one eye only
    EXPECT_TRUE(find_fireflies({&left, {}, &right, same}, counts).empty());
}

TEST(Fireflies, OfLightTakenFromAnotherPictureAreLeftAlone)
{
    Picture const p = lit_wall([](int x, int y) {
        return LitPoint{vec3{1}, vec3{x == 10 && y % 8 == 4 ? 90.0f : 1.0f}};
    });
    std::vector<std::uint32_t> from(p.pixels(), kOwnLight);
    from[wall_pixel(10, 4)] = 7;
    FireflyCounts counts;
    std::vector<Firefly> const held = find_fireflies({&p, from}, counts);
    ASSERT_EQ(held.size(), 3u);
    EXPECT_EQ(held[0].pixel, wall_pixel(10, 12));
}

TEST(Fireflies, DoNotDependOnThreads)
{
    Picture const p = lit_wall([](int x, int y) {
        vec3 const v = noisy_light(1, x, y, 3);
        return LitPoint{v, v * v * v * v * v * v};
    });
    FireflyCounts one, three;
    std::vector<Firefly> a, b;
    on_threads(1, [&] { a = fireflies_in(p, one); });
    on_threads(3, [&] { b = fireflies_in(p, three); });
    ASSERT_FALSE(a.empty());
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t k = 0; k < a.size(); ++k) {
        EXPECT_EQ(a[k].pixel, b[k].pixel);
        EXPECT_EQ(a[k].indirect, b[k].indirect);
    }
    EXPECT_EQ(one.light, three.light);
    EXPECT_EQ(one.moved, three.moved);
}

TEST(Fireflies, NeedTheSurfaces)
{
    Picture p = lit_wall([](int, int) { return LitPoint{}; });
    std::erase_if(p.layers, [](Layer const& l) { return l.name == "position"; });
    FireflyCounts counts;
    EXPECT_THROW(fireflies_in(p, counts), InputError);
}

} // namespace
} // namespace gi::test
