// The atrium: its size, its soundness, and a figure that walks.

#include "gi/core/error.h"
#include "gi/scene/generate/generate.h"
#include "gi/scene/model/world.h"
#include "gi/scene/motion/animation.h"
#include "tests/scene/scene_checks.h"

#include <algorithm>

namespace gi::test {
namespace {

/// Extent of the figure's triangles at a time.
Bounds figure_bounds(std::shared_ptr<Scene const> const& scene, SceneTime time_s)
{
    Report report;
    World const world = build_world(scene, time_s, report);
    EXPECT_TRUE(report.losses().empty());
    Bounds b;
    for (std::size_t t = 0; t < world.triangles.size(); ++t) {
        std::uint32_t const material = world.triangle_material[t];
        if (material >= scene->material_names.size() || scene->material_names[material].rfind("figure", 0) != 0)
            continue;
        for (int c = 0; c < 3; ++c) {
            vec3 const p = world.positions[world.triangles[t][c]];
            b.low = glm::min(b.low, p);
            b.high = glm::max(b.high, p);
        }
    }
    return b;
}

TEST(Atrium, HasAboutFiftyThousandTriangles)
{
    Scene const scene = generate_atrium({});
    EXPECT_GE(count_triangles(scene), 45000u);
    EXPECT_LE(count_triangles(scene), 55000u);
    expect_sound(scene);
    EXPECT_EQ(hash(scene), hash(generate_atrium({})));
}

TEST(Atrium, OptionsDecide)
{
    AtriumOptions small;
    small.bays = 1;
    small.detail = 0.1;
    small.figure = false;
    Scene const scene = generate_atrium(small);
    expect_sound(scene);
    EXPECT_TRUE(scene.skins.empty());
    EXPECT_TRUE(scene.playbacks.empty());
    AtriumOptions longer, finer;
    longer.bays = 12;
    finer.detail = 4;
    std::size_t const usual = count_triangles(generate_atrium({}));
    EXPECT_GT(count_triangles(generate_atrium(longer)), usual);
    EXPECT_GT(count_triangles(generate_atrium(finer)), 2.5 * double(usual));
}

TEST(Atrium, RefusesNonsense)
{
    auto const with = [](auto const& change) {
        AtriumOptions o;
        change(o);
        return generate_atrium(o);
    };
    EXPECT_THROW(with([](auto& o) { o.bays = 0; }), InputError);
    EXPECT_THROW(with([](auto& o) { o.bays = 1'000'000; }), InputError);
    EXPECT_THROW(with([](auto& o) { o.detail = 0; }), InputError);
    EXPECT_THROW(with([](auto& o) { o.detail = std::nan(""); }), InputError);
    EXPECT_THROW(with([](auto& o) { o.sun_elevation_deg = -5; }), InputError);
    EXPECT_THROW(with([](auto& o) { o.sun_azimuth_deg = HUGE_VAL; }), InputError);
}

TEST(Atrium, ShowsEveryKindOfMaterial)
{
    Scene const scene = generate_atrium({});
    auto const any = [&](auto const& is) {
        return std::any_of(scene.meshes.begin(), scene.meshes.end(),
                           [&](Mesh const& m) { return is(material_of(scene, m)); });
    };
    EXPECT_TRUE(any([](Material const& m) { return m.model == MaterialModel::phong; }));
    EXPECT_TRUE(any([](Material const& m) { return m.metallic == 1 && m.roughness == 0; }));
    EXPECT_TRUE(any([](Material const& m) { return m.metallic == 1 && m.roughness > 0.1f; }));
    EXPECT_TRUE(any([](Material const& m) { return m.transmission == 1 && !m.thin; }));
    EXPECT_TRUE(any([](Material const& m) { return m.alpha_mode == AlphaMode::mask; }));
    EXPECT_TRUE(any([](Material const& m) { return m.normal_map.texture >= 0; }));
    EXPECT_TRUE(any(emits));
    ASSERT_EQ(scene.lights.size(), 1u);
    EXPECT_EQ(scene.lights[0].type, LightType::directional);
    ASSERT_EQ(scene.cameras.size(), 3u);
    EXPECT_EQ(scene.cameras[0].name, "gallery");
    EXPECT_EQ(scene.cameras[1].name, "arches");
    EXPECT_EQ(scene.cameras[2].name, "courtyard");
}

TEST(Atrium, SkyIsFiniteAndBlueAbove)
{
    EnvironmentMap const sky = generate_atrium({}).environment.value();
    ASSERT_EQ(sky.radiance.size(), std::size_t(sky.width) * sky.height);
    for (vec3 const r : sky.radiance) ASSERT_TRUE(all_finite(r) && glm::min(r.x, glm::min(r.y, r.z)) >= 0);
    vec3 const zenith = sky.radiance.front();
    EXPECT_GT(zenith.z, 1.5f * zenith.x);
}

TEST(Atrium, SunShinesFromItsAzimuthAndElevation)
{
    AtriumOptions o;
    o.sun_elevation_deg = 30;
    o.sun_azimuth_deg = 90;
    Report report;
    World const world = build_world(std::make_shared<Scene>(generate_atrium(o)), std::nullopt, report);
    ASSERT_EQ(world.lights.size(), 1u);
    vec3 const expected{-std::sqrt(0.75f), -0.5f, 0};
    EXPECT_NEAR(glm::distance(world.lights[0].direction, expected), 0, 1e-5);
}

TEST(Figure, ClipLoopsWithoutAJump)
{
    Scene const scene = generate_atrium({});
    ASSERT_EQ(scene.animations.size(), 1u);
    Animation const& walk = scene.animations[0];
    EXPECT_NEAR(walk.duration_s, 1.2, 1e-6);
    ASSERT_EQ(scene.playbacks.size(), 1u);
    EXPECT_TRUE(scene.playbacks[0].loop);
    for (AnimationChannel const& c : walk.channels) {
        std::size_t const n = c.path == ChannelPath::rotation ? 4 : 3;
        ASSERT_EQ(c.values.size(), n * c.times_s.size());
        EXPECT_EQ(c.times_s.front(), 0);
        EXPECT_NEAR(c.times_s.back(), walk.duration_s, 1e-6);
        for (std::size_t i = 0; i < n; ++i) EXPECT_NEAR(c.values[i], c.values[c.values.size() - n + i], 1e-5);
    }
    Pose const start = evaluate_pose(scene, 0), end = evaluate_pose(scene, 1.2 - 1e-7);
    for (std::size_t i = 0; i < scene.nodes.size(); ++i)
        for (int c = 0; c < 4; ++c)
            EXPECT_NEAR(glm::distance(start.world_from_node[i][c], end.world_from_node[i][c]), 0, 1e-5)
                << scene.nodes[i].name;
}

TEST(Figure, WalksOnTheGround)
{
    auto const scene = std::make_shared<Scene const>(generate_atrium({}));
    Bounds const rest = figure_bounds(scene, std::nullopt);
    EXPECT_NEAR(rest.low.y, 0, 0.01);
    EXPECT_NEAR(rest.high.y, 1.75, 0.03);
    for (int k = 0; k < 12; ++k) {
        Bounds const b = figure_bounds(scene, 0.1 * k);
        EXPECT_GT(b.low.y, -0.01) << 0.1 * k << " s";
        EXPECT_LT(b.low.y, 0.02) << 0.1 * k << " s";
        EXPECT_NEAR(b.high.y, 1.73, 0.06);
        EXPECT_LT(b.high.x - b.low.x, 1.2f);
        EXPECT_LT(b.high.z - b.low.z, 1.4f);
    }
}

TEST(Figure, LegsTakeTurns)
{
    Scene const scene = generate_atrium({});
    auto const stride = [&](double time_s) { // how far the left foot is before the right
        Pose const pose = evaluate_pose(scene, time_s);
        auto const world_from = [&](char const* name) {
            auto const it = std::find_if(scene.nodes.begin(), scene.nodes.end(),
                                         [&](Node const& n) { return n.name == name; });
            return pose.world_from_node.at(std::size_t(it - scene.nodes.begin()));
        };
        dvec3 const step = dvec3(world_from("foot_l")[3] - world_from("foot_r")[3]);
        return glm::dot(step, dvec3(world_from("figure")[2]));
    };
    EXPECT_GT(stride(0.3), 0.4);
    EXPECT_LT(stride(0.9), -0.4);
    EXPECT_NEAR(stride(0.3), -stride(0.9), 0.02);
}

} // namespace
} // namespace gi::test
