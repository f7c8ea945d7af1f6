// Which light is chosen how often.

#include "gi/scene/shading/light_sampling.h"
#include "tests/support/scenes.h"

#include <gtest/gtest.h>

namespace gi::test {
namespace {

float selection(World const& world, std::size_t i) { return world.light_select.entries[i].probability; }

Light lamp(LightType type, float intensity)
{
    Light light;
    light.type = type;
    light.position = {0, 1, 0};
    light.direction = {0, -1, 0};
    light.intensity = vec3{intensity};
    return light;
}

TEST(LightTables, ChancesGoWithPowerWithinAClass)
{
    Scene scene;
    add_quad(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, add_material(scene, emitter(vec3{1})));
    add_quad(scene, {0, 0, 2}, {2, 0, 0}, {0, 1, 0}, add_material(scene, emitter(vec3{3})));
    add_quad(scene, {0, 0, 4}, {1, 0, 0}, {0, 1, 0}, add_material(scene, emitter(vec3{1}, true)));
    add_quad(scene, {0, 0, 6}, {1, 0, 0}, {0, 1, 0}, add_material(scene, lambert(vec3{1})));
    World const world = world_of(scene);
    ASSERT_EQ(world.emitters.size(), 6u);
    ASSERT_EQ(world.emitter_pdf.size(), 8u);
    EXPECT_NEAR(world.emitter_pdf[0], 0.5 / 9, 1e-6);
    EXPECT_NEAR(world.emitter_pdf[1], 0.5 / 9, 1e-6);
    EXPECT_NEAR(world.emitter_pdf[2], 3.0 / 9, 1e-6);
    EXPECT_NEAR(world.emitter_pdf[4], 1.0 / 9, 1e-6) << "both faces emit";
    EXPECT_EQ(world.emitter_pdf[6], 0);
    float sum = 0;
    for (float const p : world.emitter_pdf) sum += p;
    EXPECT_NEAR(sum, 1, 1e-6);
}

TEST(LightTables, EveryClassIsChosenAtLeastEveryTenthTime)
{
    Scene scene;
    add_quad(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, add_material(scene, emitter(vec3{1e-6f})));
    add_light(scene, lamp(LightType::point, 1e-5f));
    add_light(scene, lamp(LightType::directional, 1e5f));
    set_environment(scene, vec3{1});
    World const world = world_of(scene);
    ASSERT_EQ(world.light_select.entries.size(), 5u); // point, directional, two triangles, environment
    EXPECT_GE(selection(world, 0), 0.1f - 1e-6f);
    EXPECT_GE(selection(world, 1), 0.69f);
    EXPECT_GE(selection(world, 2) + selection(world, 3), 0.1f - 1e-6f);
    EXPECT_GE(selection(world, 4), 0.1f - 1e-6f);
    EXPECT_EQ(world.environment_pdf, selection(world, 4));
    EXPECT_EQ(world.emitter_pdf[0], selection(world, 2));
}

TEST(LightTables, BlackLightsAreNeverChosen)
{
    Scene scene;
    add_quad(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, add_material(scene, lambert(vec3{1})));
    add_light(scene, lamp(LightType::point, 0));
    add_light(scene, lamp(LightType::spot, 2));
    set_environment(scene, vec3{0});
    World const world = world_of(scene);
    EXPECT_EQ(selection(world, 0), 0);
    EXPECT_NEAR(selection(world, 1), 1, 1e-6);
    EXPECT_EQ(world.environment_pdf, 0);
    EXPECT_TRUE(world.environment_select.empty());
    EXPECT_TRUE(world.emitters.empty());
}

TEST(LightTables, ASceneWithoutLightHasNoTables)
{
    Scene scene;
    add_quad(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, add_material(scene, lambert(vec3{1})));
    World const world = world_of(scene);
    EXPECT_TRUE(world.light_select.empty());
    EXPECT_TRUE(world.emitters.empty());
    EXPECT_TRUE(world.emitter_pdf.empty());
}

TEST(LightTables, TexturedLampsAreChosenByTheirMeanEmission)
{
    Scene scene;
    scene.textures.texels = {{255, 255, 255, 255}, {0, 0, 0, 255}};
    Texture texture;
    texture.width = 2;
    texture.height = 1;
    texture.nearest = true;
    scene.textures.textures = {texture};
    Material textured = emitter(vec3{1});
    textured.emissive_map.texture = 0;
    int const material = add_material(scene, textured);
    add_quad(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, material);
    add_quad(scene, {0, 0, 2}, {1, 0, 0}, {0, 1, 0}, material);
    add_quad(scene, {0, 0, 4}, {1, 0, 0}, {0, 1, 0}, material);
    scene.meshes[0].uv0.assign(4, vec2{0.25f, 0.5f});                   // bright
    scene.meshes[1].uv0 = {{0, 0.5f}, {1, 0.5f}, {1, 0.5f}, {0, 0.5f}}; // half bright
    scene.meshes[2].uv0.assign(4, vec2{0.75f, 0.5f});                   // seems black
    World const world = world_of(scene);
    float const bright = world.emitter_pdf[0] + world.emitter_pdf[1];
    float const half = world.emitter_pdf[2] + world.emitter_pdf[3];
    float const dark = world.emitter_pdf[4] + world.emitter_pdf[5];
    EXPECT_NEAR(half / bright, 0.5, 0.1);
    EXPECT_GT(dark, 0) << "there could be light between the points that were looked at";
    EXPECT_LE(dark / bright, 0.02);
}

/// Whatever is bright under bilinear interpolation can be sampled: the neighbours of a bright texel too.
TEST(LightTables, TexelsThatLightReachesHaveAChance)
{
    Scene scene;
    add_quad(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, add_material(scene, lambert(vec3{1})));
    set_environment(scene, vec3{0});
    scene.environment->radiance[3 * 16 + 0] = vec3{1};
    World const world = world_of(scene);
    for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 16; ++x) {
            bool const near = std::abs(y - 3) <= 1 && (x <= 1 || x == 15);
            float const p = world.environment_select.entries[std::size_t(y * 16 + x)].probability;
            EXPECT_EQ(p > 0, near) << x << " " << y;
        }
}

} // namespace
} // namespace gi::test
