// The light of scenes that bring none.

#include "viewer/offline/scene_light.h"

#include <algorithm>
#include <gtest/gtest.h>

namespace viewer::test {
namespace {

/// One triangle.
gi::Scene scene_of(gi::Material const& material)
{
    gi::Scene scene;
    scene.materials = {material};
    scene.material_names = {"m"};
    gi::Mesh mesh;
    mesh.material = 0;
    scene.meshes = {mesh};
    gi::Node node;
    node.meshes = {0};
    scene.nodes = {node};
    return scene;
}

gi::Material glowing(float radiance, bool by_a_texture)
{
    gi::Material m;
    m.emission = gi::vec3{radiance};
    m.emissive_map.texture = by_a_texture ? 0 : -1;
    return m;
}

TEST(SceneLight, ScenesWithLightsAreNotTouched)
{
    for (gi::Material const& m : {glowing(0.5f, false), glowing(17, false), glowing(4, true)}) {
        gi::Scene scene = scene_of(m);
        EXPECT_EQ(add_light(scene, "studio"), "");
        EXPECT_FALSE(scene.environment);
    }
    gi::Scene lamp = scene_of({});
    lamp.lights.emplace_back().intensity = gi::vec3{1};
    lamp.nodes[0].light = 0;
    EXPECT_EQ(add_light(lamp, "studio"), "");
    gi::Scene sky = scene_of({});
    sky.environment.emplace();
    EXPECT_EQ(add_light(sky, "studio"), "");
}

TEST(SceneLight, WhatOnlyGlowsIsLit)
{
    for (gi::Material const& m : {gi::Material{}, glowing(1, true)}) {
        gi::Scene scene = scene_of(m);
        EXPECT_NE(add_light(scene, "studio").find("studio"), std::string::npos);
        ASSERT_TRUE(scene.environment);
        EXPECT_EQ(scene.background.kind, gi::BackgroundKind::color);
    }
    gi::Scene dark = scene_of({});
    EXPECT_EQ(add_light(dark, "none"), "");
    EXPECT_FALSE(dark.environment);
    gi::Scene white = scene_of({});
    EXPECT_NE(add_light(white, "white"), "");
    EXPECT_EQ(white.environment->radiance, std::vector<gi::vec3>(8, gi::vec3{1}));
    EXPECT_EQ(white.background.kind, gi::BackgroundKind::map);
    for (gi::Material const& m : {glowing(1, true), glowing(17, false)}) { // as versions that had no other light
        gi::Scene lit = scene_of(m);
        EXPECT_EQ(add_light(lit, "white"), "");
        EXPECT_FALSE(lit.environment);
    }
}

/// KHR_materials_unlit: colours as they are, if nothing else in the scene needs light.
TEST(SceneLight, UnlitScenesShowTheirColours)
{
    gi::Material m;
    m.unlit = true;
    gi::Scene scene = scene_of(m);
    EXPECT_NE(add_light(scene, "studio").find("unlit"), std::string::npos);
    EXPECT_EQ(scene.environment->radiance, std::vector<gi::vec3>(8, gi::vec3{1}));
    EXPECT_EQ(scene.background.kind, gi::BackgroundKind::color);
    gi::Scene mixed = scene_of(m);
    mixed.meshes.push_back(mixed.meshes[0]);
    mixed.meshes[1].material = -1;
    mixed.nodes[0].meshes.push_back(1);
    EXPECT_NE(add_light(mixed, "studio").find("studio"), std::string::npos);
}

/// A white diffuse surface must show its form: 1 at most (by scale), and much less where it faces the floor.
TEST(SceneLight, StudioShowsForm)
{
    gi::EnvironmentMap const map = studio_light();
    // Irradiance over pi, by the mapping of docs/methods/scene.md: u = 0.5 + atan2(x, -z) / 2 pi, v = acos(y) / pi.
    auto const reflected = [&](gi::vec3 normal) {
        double sum = 0;
        for (std::uint32_t y = 0; y < map.height; ++y)
            for (std::uint32_t x = 0; x < map.width; ++x) {
                double const a = 2 * gi::kPiD * ((x + 0.5) / map.width - 0.5),
                             p = gi::kPiD * (y + 0.5) / map.height;
                gi::dvec3 const d(std::sin(a) * std::sin(p), std::cos(p), -std::cos(a) * std::sin(p));
                double const texel_sr = 2 * gi::kPiD * gi::kPiD / (double(map.width) * map.height) * std::sin(p);
                sum += texel_sr * double(map.radiance[std::size_t(y) * map.width + x].x) *
                       std::max(0.0, glm::dot(d, gi::dvec3(normal)));
            }
        return sum / gi::kPiD;
    };
    double const key = reflected(glm::normalize(gi::vec3{0.6f, 0.7f, 0.8f})), left = reflected({-1, 0, 0}),
                 behind = reflected({0, 0, -1}), down = reflected({0, -1, 0}), front = reflected({0, 0, 1});
    EXPECT_NEAR(key, 0.97, 0.03);
    EXPECT_GT(front, 0.5);
    for (double const side : {left, behind, down}) {
        EXPECT_GT(side, 0.08);
        EXPECT_LT(side, 0.5 * key);
    }
}

} // namespace
} // namespace viewer::test
