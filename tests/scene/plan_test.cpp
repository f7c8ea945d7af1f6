// What a scene needs is built, what it does not need is left out, and the reasons say why.

#include "gi/scene/model/plan.h"
#include "tests/support/scenes.h"

#include <algorithm>
#include <gtest/gtest.h>

namespace gi::test {
namespace {

PlanItem item(ScenePlan const& plan, std::string const& begin)
{
    auto const it = std::find_if(plan.items.begin(), plan.items.end(),
                                 [&](PlanItem const& i) { return i.what.starts_with(begin); });
    EXPECT_NE(it, plan.items.end()) << begin;
    return it == plan.items.end() ? PlanItem{} : *it;
}

void quad_of(Scene& scene, Material const& material)
{
    add_quad(scene, {0, float(scene.meshes.size()), 0}, {1, 0, 0}, {0, 0, 1}, add_material(scene, material));
}

TEST(Plan, MattSceneNeedsNothing)
{
    Scene scene;
    quad_of(scene, lambert(vec3{0.5f}));
    ScenePlan const plan = plan_scene(world_of(scene));
    EXPECT_FALSE(plan.alpha_tests || plan.environment || plan.emitters || plan.punctual_lights ||
                 plan.delta_lobes || plan.transmission || plan.textures || plan.normal_maps || plan.skins ||
                 plan.morphs || plan.motion || plan.moving_parts);
    for (PlanItem const& i : plan.items) {
        EXPECT_FALSE(i.build) << i.what;
        EXPECT_FALSE(i.reason.empty()) << i.what;
    }
}

TEST(Plan, EverythingThatIsThereIsBuilt)
{
    Scene scene;
    Material masked = lambert(vec3{0.5f});
    masked.alpha_mode = AlphaMode::mask;
    masked.base_color_map.texture = masked.normal_map.texture = 0;
    scene.textures.texels.resize(1);
    scene.textures.textures = {Texture{0, 1, 1}};
    quad_of(scene, masked);
    scene.meshes[0].uv0.assign(4, vec2{0});
    quad_of(scene, glass(1.5f, false));
    quad_of(scene, mirror(vec3{0.9f}));
    quad_of(scene, emitter(vec3{3}));
    add_light(scene, Light{});
    set_environment(scene, vec3{1});
    AnimationChannel slide;
    slide.node = 0;
    slide.times_s = {0, 1};
    slide.values = {0, 0, 0, 1, 0, 0};
    scene.animations = {{"slide", {slide}, 1}};
    scene.playbacks = {{0, 0, 1, true}};
    scene.skins.resize(1);
    scene.meshes[0].morph_targets.resize(1);
    ScenePlan const plan = plan_scene(world_of(scene));
    EXPECT_TRUE(plan.alpha_tests && plan.environment && plan.emitters && plan.punctual_lights &&
                plan.delta_lobes && plan.transmission && plan.textures && plan.normal_maps && plan.skins &&
                plan.morphs && plan.motion && plan.moving_parts);
    for (PlanItem const& i : plan.items) EXPECT_TRUE(i.build) << i.what;
    EXPECT_EQ(item(plan, "alpha").reason, "1 of 4 materials are masks or blend");
    EXPECT_EQ(item(plan, "delta").reason, "2 of 4 materials are perfectly smooth");
    EXPECT_EQ(item(plan, "emissive").reason, "2 triangles emit");
    EXPECT_EQ(item(plan, "alpha").name, "alpha_tests");
    ASSERT_EQ(item(plan, "alpha").numbers.size(), 2u);
    EXPECT_EQ(item(plan, "alpha").numbers[1].key, "materials");
    EXPECT_EQ(std::get<std::int64_t>(item(plan, "alpha").numbers[1].value), 4);
    EXPECT_EQ(item(plan, "updates").reason, "2 of 8 triangles in 1 of 4 instances can move: clip 'slide'");
}

TEST(Plan, NumbersOfSentencesAreDataToo)
{
    PlanText const text =
        PlanText("{} lattices of {} m, ", {figure("lattices", 3), figure("cell_m", 0.12345, 3)}) +
        PlanText("{}", {figure_of_bytes("memory_bytes", 1234567)});
    EXPECT_EQ(text.text, "3 lattices of 0.123 m, 1.23 MB");
    ASSERT_EQ(text.numbers.size(), 3u);
    EXPECT_EQ(text.numbers[0].key, "lattices");
    EXPECT_EQ(std::get<std::int64_t>(text.numbers[0].value), 3);
    EXPECT_EQ(std::get<double>(text.numbers[1].value), 0.12345);
    EXPECT_EQ(std::get<std::int64_t>(text.numbers[2].value), 1234567);
    EXPECT_THROW(PlanText("one", {figure("many", 2)}), std::out_of_range);
}

TEST(Plan, OnlyMaterialsInUseCount)
{
    Scene scene;
    quad_of(scene, lambert(vec3{0.5f}));
    add_material(scene, glass(1.5f, false));
    EXPECT_FALSE(plan_scene(world_of(scene)).transmission);
}

TEST(Plan, BlackMapsAreNotSampled)
{
    Scene scene;
    quad_of(scene, lambert(vec3{0.5f}));
    set_environment(scene, vec3{0});
    ScenePlan const plan = plan_scene(world_of(scene));
    EXPECT_FALSE(plan.environment);
    EXPECT_EQ(item(plan, "environment").reason, "the map is black");
}

} // namespace
} // namespace gi::test
