// Light kept of a small picture is found again on the surfaces that it fell on.

#include "gi/surfaces/kept_light.h"

#include "gi/core/error.h"
#include "tests/support/scenes.h"

#include <gtest/gtest.h>
#include <iostream>
#include <limits>

namespace gi::test {
namespace {

constexpr int kWidth = 32, kHeight = 24;

struct Pixel {
    vec3 albedo{0.5f}, normal{0, 0, 1}, position{0}, l1{0}, l2{0}, light_normal{0};
    float depth = 2;
};

CameraRays rays() { return camera_rays(look_at({0, 0, 0}, {0, 0, -1}, 60), kWidth, kHeight, dvec3{0}); }

/// A point in the middle of a pixel, in the plane z = -depth.
vec3 in_plane(float x, float y, float depth)
{
    Ray const ray = rays().through({x + 0.5f, y + 0.5f});
    return ray.direction * (depth / -ray.direction.z);
}

template <class At>
KeptLight kept(At const& at, bool light_normals = false)
{
    Picture p{kWidth, kHeight, {}, {}};
    if (light_normals) p.add("light_normal", 3);
    for (char const* const name : {"L1", "L2", "albedo", "normal", "position"}) p.add(name, 3);
    p.add("depth", 1);
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            Pixel const v = at(x, y);
            std::size_t const i = std::size_t(y * kWidth + x);
            for (auto const& [name, value] : {std::pair{"L1", v.l1},
                                              {"L2", v.l2},
                                              {"albedo", v.albedo},
                                              {"normal", v.normal},
                                              {"position", v.position},
                                              {"light_normal", v.light_normal}})
                for (int c = 0; p.find(name) && c < 3; ++c) p.find(name)->data[3 * i + std::size_t(c)] = value[c];
            p.find("depth")->data[i] = v.depth;
        }
    return KeptLight(p, rays(), dvec3{0});
}

TEST(KeptLight, ConstantLightStaysConstant)
{
    KeptLight const light = kept([](int x, int y) {
        Pixel p;
        p.albedo = {0.3f + 0.5f * float(x % 2), 0.4f, 0.9f - 0.7f * float(y % 2)}; // a texture, which is no light
        p.position = in_plane(float(x), float(y), 2);
        p.l1 = p.albedo * vec3{1, 2, 3};
        p.l2 = p.albedo * 0.25f;
        return p;
    });
    for (float y = 0; y < kHeight; y += 0.31f)
        for (float x = 0; x < kWidth; x += 0.27f) {
            vec3 const at = in_plane(x - 0.5f, y - 0.5f, 2);
            auto const found = light.find(at, {0, 0, 1});
            ASSERT_TRUE(found.has_value());
            for (FoundLight const& f : {*found, light.find(at, {0, 0, 1}, {x, y})}) {
                EXPECT_NEAR(f.likeness, 1, 1e-3f);
                for (int c = 0; c < 3; ++c) {
                    ASSERT_NEAR(f.direct[c], float(c + 1), 3e-5f);
                    ASSERT_NEAR(f.indirect[c], 0.25f, 1e-5f);
                }
            }
        }
}

TEST(KeptLight, LightDoesNotCrossEdges)
{
    // Left a wall 2 m away with light 1, right one 3 m away with light 10; below, a floor with light 100.
    KeptLight const light = kept([](int x, int y) {
        Pixel p;
        bool const floor = y >= 16;
        p.depth = x < 16 || floor ? 2 : 3;
        p.position = in_plane(float(x), float(y), p.depth);
        p.normal = floor ? vec3{0, 1, 0} : vec3{0, 0, 1};
        p.l1 = p.albedo * (floor ? 100.0f : x < 16 ? 1.0f : 10.0f);
        return p;
    });
    for (float x = 14.5f; x < 17.5f; x += 0.25f) // where a pixel of either is at most two away
        for (bool const left : {true, false}) {
            FoundLight const f = light.find(in_plane(x - 0.5f, 7.5f, left ? 2.0f : 3.0f), {0, 0, 1}, {x, 8});
            EXPECT_NEAR(f.direct.x, left ? 1 : 10, left ? 0.02f : 0.2f) << x;
            EXPECT_GT(f.likeness, 0.9f) << x;
        }
    for (float y = 14; y < 17.5f; y += 0.25f) {
        FoundLight const wall = light.find(in_plane(7.5f, y - 0.5f, 2), {0, 0, 1}, {8, y});
        EXPECT_NEAR(wall.direct.x, 1, 0.2f) << y;
    }
}

/// A curtain, one fold of which is 10 pixels wide.
vec3 fold_normal(float x)
{
    float const angle = 0.5f * std::sin(x * 6.2832f / 10);
    return {std::sin(angle), 0, std::cos(angle)};
}

/// Light that was blurred over some pixels is given back the folds of its surface, from normals blurred likewise.
TEST(KeptLight, BlurredFoldsAreShadedByTheirNormals)
{
    auto const lit = [](vec3 n) { return std::max(0.0f, glm::dot(n, glm::normalize(vec3{1, 0.2f, 1}))); };
    auto const blurred = [](int x, auto const& f) {
        auto sum = f(fold_normal(float(x)));
        for (int k = 1; k <= 3; ++k) sum += f(fold_normal(float(x + k))) + f(fold_normal(float(x - k)));
        return sum / 7.0f;
    };
    auto const pixel = [&](int x, int y) {
        Pixel p;
        p.normal = fold_normal(float(x));
        p.position = in_plane(float(x), float(y), 2);
        p.l1 = p.albedo * blurred(x, lit);
        p.light_normal = blurred(x, [](vec3 n) { return n; });
        return p;
    };
    KeptLight const plain = kept(pixel), light = kept(pixel, true);
    double error = 0, of_plain = 0;
    int n = 0;
    for (float x = 4; x < kWidth - 4; x += 0.27f, ++n) {
        vec3 const at = in_plane(x, 12, 2), normal = fold_normal(x);
        error += std::abs(double(light.find(at, normal, {x + 0.5f, 12.5f}).direct.x - lit(normal)));
        of_plain += std::abs(double(plain.find(at, normal, {x + 0.5f, 12.5f}).direct.x - lit(normal)));
    }
    std::cout << "mean error " << error / n << ", without the normals " << of_plain / n << '\n';
    EXPECT_LT(error, 0.35 * of_plain);
}

TEST(KeptLight, ThinThingsGetTheLightAroundThemAndAreCounted)
{
    KeptLight const light = kept([](int x, int y) {
        Pixel p;
        p.position = in_plane(float(x), float(y), 2);
        p.l1 = p.albedo * 4.0f;
        return p;
    });
    FoundLight const f = light.find(in_plane(9.5f, 9.5f, 1), {1, 0, 0}, {10, 10});
    EXPECT_LT(f.likeness, KeptLight::kUnlike);
    EXPECT_NEAR(f.direct.x, 4, 1e-3f);
    FoundLight const turned = light.find(in_plane(9.5f, 9.5f, 2), {0, 0, -1}, {10, 10}); // of the other side
    EXPECT_LT(turned.likeness, KeptLight::kUnlike);
}

TEST(KeptLight, DarkChannelsTakeTheLightOfOtherPixels)
{
    KeptLight const light = kept([](int x, int y) {
        Pixel p;
        p.albedo = x % 2 == 0 ? vec3{0.8f, 0, 0} : vec3{0.5f, 0.5f, 0}; // says nothing of green, or of blue
        p.position = in_plane(float(x), float(y), 2);
        p.l1 = p.albedo * vec3{2, 6, 9};
        return p;
    });
    FoundLight const f = light.find(in_plane(8, 8, 2), {0, 0, 1}, {8.5f, 8.5f}); // in the middle of a red pixel
    EXPECT_NEAR(f.direct.x, 2, 1e-4f);
    EXPECT_NEAR(f.direct.y, 6, 1e-4f);
    EXPECT_EQ(f.direct.z, 0);
}

TEST(KeptLight, IsNotFoundBesideThePictureAndIsTheMeanWithoutSurfaces)
{
    KeptLight const light = kept([](int x, int y) {
        Pixel p;
        p.position = in_plane(float(x), float(y), 2);
        p.l1 = vec3{1};
        if (y < 12) p.normal = vec3{0}; // sky
        if (y > 20) p.l1 = vec3{std::numeric_limits<float>::quiet_NaN()};
        return p;
    });
    EXPECT_FALSE(light.find({0, 0, 2}, {0, 0, 1}).has_value()) << "behind the camera";
    EXPECT_FALSE(light.find(in_plane(-5, 8, 2), {0, 0, 1}).has_value());
    EXPECT_FALSE(light.find(in_plane(5, 40, 2), {0, 0, 1}).has_value());
    for (float const y : {4.0f, 22.5f}) {
        FoundLight const none = light.find(in_plane(7.5f, y, 2), {0, 0, 1}, {8, y});
        EXPECT_EQ(none.direct, vec3{2}) << y; // 1 over the albedo
        EXPECT_EQ(none.likeness, 0) << y;
    }
    EXPECT_GT(light.find(in_plane(7.5f, 14, 2), {0, 0, 1}, {8, 14}).direct.x, 0);
}

TEST(KeptLight, NamesTheLayerThatIsMissing)
{
    Picture p{4, 4, {}, {}};
    for (char const* const name : {"L1", "L2", "albedo", "normal"}) p.add(name, 3);
    try {
        KeptLight const light(p, rays(), dvec3{0});
        ADD_FAILURE();
    } catch (InputError const& e) {
        EXPECT_NE(std::string(e.what()).find("position"), std::string::npos) << e.what();
    }
}

} // namespace
} // namespace gi::test
