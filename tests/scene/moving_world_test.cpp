// A world that is advanced step by step equals a newly built one bit for bit; static parts are not touched.

#include "gi/core/error.h"
#include "gi/scene/generate/figure.h"
#include "gi/scene/load/load.h"
#include "gi/scene/motion/moving_world.h"
#include "tests/support/data.h"
#include "tests/support/scenes.h"

#include <cstring>
#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>
#include <malloc.h>

#if defined(__SANITIZE_ADDRESS__)
extern "C" std::size_t __sanitizer_get_current_allocated_bytes();
#endif

namespace gi::test {
namespace {

template <class T>
bool same_bytes(std::vector<T> const& a, std::vector<T> const& b)
{
    return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

void expect_same_bsdf(Bsdf const& a, Bsdf const& b)
{
    EXPECT_EQ(a.model, b.model);
    EXPECT_EQ(a.thin, b.thin);
    for (auto const field :
         {&Bsdf::diffuse, &Bsdf::f0, &Bsdf::f90, &Bsdf::again, &Bsdf::transmitted, &Bsdf::phong_specular})
        EXPECT_EQ(a.*field, b.*field);
    for (auto const field :
         {&Bsdf::coat_f0, &Bsdf::coat_f90, &Bsdf::alpha, &Bsdf::clear, &Bsdf::ior, &Bsdf::phong_exponent})
        EXPECT_EQ(a.*field, b.*field);
}

/// Every array and every table.
void expect_same(World const& a, World const& b)
{
    EXPECT_EQ(a.origin, b.origin);
    EXPECT_EQ(a.bounds.low, b.bounds.low);
    EXPECT_EQ(a.bounds.high, b.bounds.high);
    EXPECT_TRUE(same_bytes(a.positions, b.positions));
    EXPECT_TRUE(same_bytes(a.normals, b.normals));
    EXPECT_TRUE(same_bytes(a.tangents, b.tangents));
    EXPECT_TRUE(same_bytes(a.uv0, b.uv0));
    EXPECT_TRUE(same_bytes(a.uv1, b.uv1));
    EXPECT_TRUE(same_bytes(a.colors, b.colors));
    EXPECT_TRUE(same_bytes(a.triangles, b.triangles));
    EXPECT_TRUE(same_bytes(a.triangle_material, b.triangle_material));
    EXPECT_TRUE(same_bytes(a.surfaces, b.surfaces));
    EXPECT_EQ(a.instances, b.instances);
    EXPECT_EQ(a.static_instances, b.static_instances);
    EXPECT_EQ(a.static_triangles, b.static_triangles);
    EXPECT_EQ(a.static_vertices, b.static_vertices);
    EXPECT_EQ(a.materials, b.materials);
    ASSERT_EQ(a.bsdfs.size(), b.bsdfs.size());
    for (std::size_t i = 0; i < a.bsdfs.size(); ++i) expect_same_bsdf(a.bsdfs[i], b.bsdfs[i]);
    EXPECT_EQ(a.lights, b.lights);
    EXPECT_EQ(a.cameras, b.cameras);
    EXPECT_EQ(a.environment_rotation_rad, b.environment_rotation_rad);
    EXPECT_EQ(a.environment_scale, b.environment_scale);
    EXPECT_EQ(a.emitters, b.emitters);
    EXPECT_TRUE(same_bytes(a.emitter_pdf, b.emitter_pdf));
    EXPECT_TRUE(same_bytes(a.light_select.entries, b.light_select.entries));
    EXPECT_EQ(a.light_select.total, b.light_select.total);
    EXPECT_TRUE(same_bytes(a.environment_select.entries, b.environment_select.entries));
    EXPECT_EQ(a.environment_pdf, b.environment_pdf);
}

World fresh(std::shared_ptr<Scene const> const& scene, double time_s, std::optional<dvec3> origin = {})
{
    Report report;
    return build_world(scene, time_s, report, origin);
}

AnimationChannel channel(std::int32_t node, ChannelPath path, std::vector<float> times, std::vector<float> values)
{
    return {node, path, Interpolation::linear, std::move(times), std::move(values)};
}

constexpr float kEven = 0.99f; ///< scale of the lamp while it does not move

/// A room with a walking figure; a lamp of triangles and one of none, and a camera, that all ride on nodes of a
/// clip; a banner that a clip scales down to nothing and mirrors; a sky.
std::shared_ptr<Scene const> busy_scene(dvec3 away = dvec3{0})
{
    Scene scene;
    int const wall = add_material(scene, lambert(vec3{0.6f}));
    int const glow = add_material(scene, emitter(vec3{5}));
    add_quad(scene, {-3, 3, -3}, {1, 0, 0}, {0, 0, 1}, glow); // node 0: turns, with a lamp and a camera on it
    add_quad(scene, {1, 1, 1}, {1, 0, 0}, {0, 1, 0}, wall);   // node 1: vanishes and comes back mirrored
    scene.meshes[1].normals.assign(4, vec3{0, 0, 1});
    add_quad(scene, {-2, 4, -2}, {1, 0, 0}, {0, 0, 1}, glow); // node 2: rests and shines
    Light lamp;
    lamp.type = LightType::spot;
    lamp.intensity = vec3{20};
    add_light(scene, lamp); // node 3
    scene.nodes[3].parent = 0;
    lamp.type = LightType::directional;
    lamp.direction = glm::normalize(vec3{1, -2, 0.5f});
    add_light(scene, lamp); // node 4: rests
    Node eye;
    eye.parent = 0;
    eye.camera = 0;
    scene.nodes.push_back(eye);
    scene.cameras.resize(1);
    add_box(scene, {-4, 0, -4}, {4, 5, 4}, wall, true); // six meshes that rest
    set_environment(scene, vec3{0.3f});
    scene.environment->radiance[40] = vec3{9};
    Animation clip;
    clip.name = "machine";
    clip.duration_s = 2;
    float const half = std::sqrt(0.5f);
    clip.channels = {channel(0, ChannelPath::rotation, {0, 1, 2}, {0, 0, 0, 1, 0, half, 0, half, 0, 0, 0, 1}),
                     channel(1, ChannelPath::scale, {0, 1, 2}, {1, 1, 1, 0, 0, 0, -1, 1, 1}),
                     channel(2, ChannelPath::scale, {0, 1}, {kEven, 1, 1, kEven, 1, 1})};
    scene.animations = {clip};
    scene.playbacks = {{0, 0, 1, true}};
    add_figure(scene, glm::translate(dmat4(1), dvec3{0.5, 0, 0.25}), 0.5);
    if (away == dvec3{0}) return std::make_shared<Scene const>(std::move(scene));
    Scene moved;
    append(moved, std::move(scene), "all", glm::translate(dmat4(1), away));
    return std::make_shared<Scene const>(std::move(moved));
}

TEST(MovingWorld, WhatCannotMoveComesFirst)
{
    auto const scene = busy_scene();
    World const w = fresh(scene, 0);
    EXPECT_EQ(w.instances, 11u);
    EXPECT_EQ(w.static_instances, 7u) << "the box, and the lamp whose channel says the same at all times";
    EXPECT_EQ(w.static_triangles, 14u);
    EXPECT_EQ(w.static_vertices, 28u);
    for (std::size_t t = 0; t < w.triangles.size(); ++t)
        for (int k = 0; k < 3; ++k) EXPECT_EQ(w.triangles[t][k] < w.static_vertices, t < w.static_triangles);
    EXPECT_EQ(reasons_for_motion(*scene), (std::vector<std::string>{"clip 'machine'", "skin, clip 'walk'"}));
}

/// Without clips that play nodes keep their order.
TEST(MovingWorld, NothingMovesWithoutPlaybacks)
{
    Scene scene = *busy_scene();
    scene.playbacks.clear();
    World const w = fresh(std::make_shared<Scene const>(scene), 0);
    EXPECT_EQ(w.static_triangles, w.triangles.size());
    EXPECT_EQ(w.triangle_material.front(), 1u) << "the quad of node 0";
    scene.playbacks = {{0, 0, 0, true}}; // a clip that stands still
    EXPECT_EQ(fresh(std::make_shared<Scene const>(scene), 0).static_triangles, w.triangles.size());
    scene.playbacks.clear();
    scene.nodes[1].driven = true;
    EXPECT_EQ(fresh(std::make_shared<Scene const>(scene), 0).static_triangles, w.triangles.size() - 2);
}

TEST(MovingWorld, IsTheWorldBuiltAfresh)
{
    auto const scene = busy_scene();
    Report report;
    MovingWorld moving(scene, 0, report);
    expect_same(moving.world(), fresh(scene, 0));
    for (double const t : {0.1, 0.7, 1.0, 1.3, 1.999, 0.05, 17.3, -4.0}) {
        SCOPED_TRACE(t);
        Changes const c = moving.advance(t);
        World const w = fresh(scene, t);
        expect_same(moving.world(), w);
        EXPECT_TRUE(c.geometry && c.lights && c.cameras && c.emitters && c.light_select);
        EXPECT_FALSE(c.materials || c.environment || c.coverage);
        EXPECT_EQ(c.moved_instances, 4u);
        EXPECT_EQ(c.moved_triangles, w.triangles.size() - w.static_triangles);
        EXPECT_EQ(c.flat_triangles, t == 1.0 ? 2u : 0u);
        EXPECT_EQ(c.reasons.size(), 4u) << fmt::format("{}", fmt::join(c.reasons, "\n"));
    }
}

TEST(MovingWorld, IsTheWorldBuiltAfreshFarAway)
{
    auto const scene = busy_scene({1e6, 2e6, -1e6});
    Report report;
    MovingWorld moving(scene, 0, report);
    EXPECT_GT(glm::length(moving.world().origin), 1e6);
    for (double const t : {0.3, 1.0, 1.7}) {
        moving.advance(t);
        expect_same(moving.world(), fresh(scene, t, moving.world().origin));
    }
    // And but for where it is, the world of the same scene at home.
    World const home = fresh(busy_scene(), 1.7);
    dvec3 const away = dvec3{1e6, 2e6, -1e6} - moving.world().origin;
    for (std::size_t i = 0; i < home.positions.size(); ++i)
        ASSERT_LT(glm::distance(dvec3(moving.world().positions[i]), dvec3(home.positions[i]) + away), 1e-5);
}

TEST(MovingWorld, StaticPartsStayInPlaceAndUntouched)
{
    auto const scene = busy_scene();
    Report report;
    MovingWorld moving(scene, 0, report);
    World const& w = moving.world();
    World const before = w;
    void const* const places[] = {w.positions.data(), w.normals.data(), w.triangles.data(), w.surfaces.data()};
    for (double t = 0.05; t < 4; t += 0.37) moving.advance(t);
    EXPECT_EQ(places[0], w.positions.data());
    EXPECT_EQ(places[1], w.normals.data());
    EXPECT_EQ(places[2], w.triangles.data());
    EXPECT_EQ(places[3], w.surfaces.data());
    std::size_t const vertices = w.static_vertices, triangles = w.static_triangles;
    EXPECT_EQ(0, std::memcmp(before.positions.data(), w.positions.data(), vertices * sizeof(vec3)));
    EXPECT_EQ(0, std::memcmp(before.normals.data(), w.normals.data(), vertices * sizeof(vec3)));
    EXPECT_EQ(0, std::memcmp(before.triangles.data(), w.triangles.data(), triangles * sizeof(uvec3)));
    EXPECT_EQ(0, std::memcmp(before.surfaces.data(), w.surfaces.data(), triangles * sizeof(Surface)));
    EXPECT_NE(0, std::memcmp(before.positions.data(), w.positions.data(), w.positions.size() * sizeof(vec3)));
}

/// A second look at one moment costs nothing and says so.
TEST(MovingWorld, WhatDidNotMoveIsNotNamed)
{
    Report report;
    MovingWorld moving(busy_scene(), 0.3, report);
    Changes c = moving.advance(0.3);
    EXPECT_FALSE(c.any());
    EXPECT_TRUE(c.reasons.empty());
    EXPECT_EQ(c.moved_instances, 0u);
    Scene held = *busy_scene();
    for (Playback& p : held.playbacks) p.loop = false;
    MovingWorld ended(std::make_shared<Scene const>(held), 100, report);
    EXPECT_FALSE(ended.advance(101).any()) << "held at the end of its clips";
    EXPECT_TRUE(ended.advance(0.5).geometry);
}

TEST(MovingWorld, DrivenNodesFollowAPoseFromOutside)
{
    Scene scene = *busy_scene();
    scene.nodes[1].driven = true;
    auto const shared = std::make_shared<Scene const>(scene);
    Report report;
    MovingWorld moving(shared, 0.2, report);
    Pose pose = evaluate_pose(*shared, 0.2);
    pose.world_from_node[1] = glm::translate(dmat4(1), dvec3{0, 0, 1});
    Changes const c = moving.advance(pose);
    EXPECT_EQ(c.moved_instances, 1u);
    EXPECT_TRUE(c.geometry);
    EXPECT_FALSE(c.lights || c.cameras || c.emitters);
}

/// Every avatar through its clip, at uneven steps.
class MovingAvatar : public testing::TestWithParam<char const*> {};

TEST_P(MovingAvatar, IsTheWorldBuiltAfresh)
{
    std::string const file = std::string("avatars/") + GetParam();
    LIGHTWELL_NEED_DATA(file);
    Report report;
    Scene loaded = load_scene((shared_data() / file).string(), report);
    for (SkinningMethod const method : {SkinningMethod::linear, SkinningMethod::dual_quaternion}) {
        for (Skin& s : loaded.skins) s.method = method;
        auto const scene = std::make_shared<Scene const>(loaded);
        bool const plays = !scene->playbacks.empty();
        MovingWorld moving(scene, 0, report);
        double const duration =
            plays ? scene->animations[std::size_t(scene->playbacks[0].animation)].duration_s : 1;
        bool moved = false;
        for (int step = 1; step <= 5; ++step) {
            double const t = duration * 0.237 * step;
            std::vector<vec3> const before = moving.world().positions;
            Changes const c = moving.advance(t);
            EXPECT_EQ(c.geometry, !same_bytes(before, moving.world().positions));
            moved |= c.geometry;
            expect_same(moving.world(), fresh(scene, t));
            for (vec3 const p : moving.world().positions) ASSERT_TRUE(all_finite(p));
        }
        EXPECT_EQ(moved, plays);
    }
}
INSTANTIATE_TEST_SUITE_P(All, MovingAvatar,
                         testing::Values("cesium_man.glb", "fox.glb", "lee_perry_smith_head.glb",
                                         "morph_stress_test.glb", "quaternius_horse.glb", "quaternius_human.glb",
                                         "robot_expressive.glb"),
                         [](auto const& avatar) {
                             std::string const name = avatar.param;
                             return name.substr(0, name.find('.'));
                         });

std::size_t bytes_in_use()
{
#if defined(__SANITIZE_ADDRESS__)
    return __sanitizer_get_current_allocated_bytes(); // resident pages include what was freed
#else
    auto const heap = mallinfo2();
    return heap.uordblks + heap.hblkhd;
#endif
}

TEST(MovingWorld, TenThousandFramesNeedNoMoreMemoryAndStayNumbers)
{
    Scene scene;
    add_quad(scene, {-2, 3, -2}, {4, 0, 0}, {0, 0, 4}, add_material(scene, emitter(vec3{5})));
    add_figure(scene, dmat4(1), 0.3);
    Report report;
    MovingWorld moving(std::make_shared<Scene const>(std::move(scene)), 0, report);
    World const& w = moving.world();
    std::size_t before = 0;
    for (int frame = 0; frame < 10000; ++frame) {
        moving.advance(frame / 30.0);
        if (frame == 100) before = bytes_in_use();
        if (frame % 97 != 0) continue;
        for (vec3 const p : w.positions) ASSERT_TRUE(all_finite(p));
        for (vec3 const n : w.normals) ASSERT_TRUE(all_finite(n));
        for (Surface const& s : w.surfaces)
            ASSERT_TRUE(all_finite(s.corner) && all_finite(s.edge1) && std::isfinite(s.normal_scale));
    }
    // 10,000 leaks of one vector of the figure's matrices would be 8 MiB.
    EXPECT_LE(bytes_in_use(), before + (std::size_t(1) << 20));
}

/// A clip that takes a mesh beyond all bounds and back.
TEST(MovingWorld, VerticesThatAreNotFiniteAreLeftOutMeanwhile)
{
    Scene scene;
    int const wall = add_material(scene, lambert(vec3{0.6f}));
    add_quad(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, wall);
    add_quad(scene, {0, 0, 2}, {1, 0, 0}, {0, 1, 0}, wall);
    scene.animations = {{"away", {channel(0, ChannelPath::scale, {0, 1, 2}, {1, 1, 1, 3e38f, 1, 1, 1, 1, 1})}, 2}};
    scene.playbacks = {{0, 0, 1, true}};
    auto const shared = std::make_shared<Scene const>(std::move(scene));
    Report report;
    MovingWorld moving(shared, 0, report);
    EXPECT_TRUE(report.losses().empty());
    for (double const t : {1.0, 0.5, 0.25, 2.0}) {
        Changes const c = moving.advance(t);
        expect_same(moving.world(), fresh(shared, t));
        EXPECT_EQ(c.flat_triangles, t < 2 ? 2u : 0u);
        for (vec3 const p : moving.world().positions) EXPECT_TRUE(all_finite(p));
    }
    EXPECT_EQ(moving.world().bounds.high, (vec3{1, 1, 2}));
}

TEST(MovingWorld, LightsThatAreSetGiveTheWorldOfThatScene)
{
    Scene scene = *busy_scene();
    Report report;
    MovingWorld moving(std::make_shared<Scene const>(scene), 0.4, report);
    // In a frame of the node: brighter and wider.
    Light spot = moving.world().lights[0];
    spot.intensity = {3, 50, 7};
    spot.cos_outer = 0.1f;
    Changes c = moving.set_light(0, spot);
    EXPECT_TRUE(c.lights && c.light_select);
    EXPECT_FALSE(c.geometry || c.materials || c.environment || c.emitters);
    EXPECT_EQ(c.reasons, (std::vector<std::string>{"lights: light 0 was set"}));
    EXPECT_FALSE(moving.set_light(0, spot).any());
    scene.lights[0].intensity = spot.intensity;
    scene.lights[0].cos_outer = spot.cos_outer;
    expect_same(moving.world(), fresh(std::make_shared<Scene const>(scene), 0.4));
    moving.advance(0.9);
    expect_same(moving.world(), fresh(std::make_shared<Scene const>(scene), 0.9));
    // Turned by hand; its node cannot move, so that it stays.
    Light sun = moving.world().lights[1];
    sun.direction = {0, -1, 0};
    moving.set_light(1, sun);
    moving.advance(1.4);
    EXPECT_EQ(moving.world().lights[1].direction, (vec3{0, -1, 0}));
    EXPECT_THROW(moving.set_light(2, sun), InputError);
    sun.intensity.x = std::numeric_limits<float>::quiet_NaN();
    EXPECT_THROW(moving.set_light(1, sun), InputError);
}

TEST(MovingWorld, MaterialsThatAreSetGiveTheWorldOfThatScene)
{
    Scene scene = *busy_scene();
    Report report;
    MovingWorld moving(std::make_shared<Scene const>(scene), 0.4, report);
    auto const set = [&](std::size_t k, auto const& change) {
        change(scene.materials[k]);
        Changes const c = moving.set_material(k, scene.materials[k]);
        expect_same(moving.world(), fresh(std::make_shared<Scene const>(scene), 0.4));
        EXPECT_TRUE(c.materials);
        EXPECT_FALSE(c.geometry || c.lights || c.bounds || c.environment);
        return c;
    };
    Changes c = set(0, [](Material& m) { m.base_color = {0.1f, 0.9f, 0.2f}; });
    EXPECT_FALSE(c.emitters || c.light_select || c.coverage);
    c = set(1, [](Material& m) { m.emission = {1, 2, 3}; });
    EXPECT_TRUE(c.emitters && c.light_select);
    c = set(0, [](Material& m) { m.double_sided = false; });
    EXPECT_FALSE(c.emitters);
    c = set(0, [](Material& m) { m.emission = vec3{0.01f}; });
    EXPECT_TRUE(c.emitters);
    c = set(1, [](Material& m) { m.emission = vec3{0}; });
    EXPECT_TRUE(c.emitters);
    c = set(0, [](Material& m) { m.emission = vec3{0}; });
    EXPECT_TRUE(moving.world().emitter_pdf.empty());
    c = set(2, [](Material& m) { m.alpha_mode = AlphaMode::mask; });
    EXPECT_TRUE(c.coverage);
    EXPECT_FALSE(moving.set_material(2, scene.materials[2]).any());
    moving.advance(1.1);
    expect_same(moving.world(), fresh(std::make_shared<Scene const>(scene), 1.1));
    Material textured;
    textured.base_color_map.texture = 0;
    EXPECT_THROW(moving.set_material(0, textured), InputError);
    EXPECT_THROW(moving.set_material(99, Material{}), InputError);
}

TEST(MovingWorld, EnvironmentsThatAreSetGiveTheWorldOfThatScene)
{
    Scene scene = *busy_scene();
    Report report;
    MovingWorld moving(std::make_shared<Scene const>(scene), 0.4, report);
    auto const check = [&] { expect_same(moving.world(), fresh(std::make_shared<Scene const>(scene), 0.4)); };
    Changes c = moving.turn_environment(0.7f, vec3{1});
    EXPECT_TRUE(c.environment);
    EXPECT_FALSE(c.light_select) << "turning takes no new table";
    scene.environment->rotation_rad = 0.7f;
    check();
    EXPECT_FALSE(moving.turn_environment(0.7f, vec3{1}).any());
    c = moving.turn_environment(0.2f, {2, 1, 0.5f});
    EXPECT_TRUE(c.light_select);
    scene.environment->rotation_rad = 0.2f;
    scene.environment->scale = {2, 1, 0.5f};
    check();
    EnvironmentMap other;
    other.width = 4;
    other.height = 2;
    other.radiance.assign(8, vec3{2});
    other.rotation_rad = 1;
    c = moving.set_environment(std::make_shared<EnvironmentMap const>(other));
    EXPECT_TRUE(c.environment && c.light_select);
    scene.environment = other;
    check();
    EXPECT_EQ(view(moving.world()).environment_width, 4u);
    moving.set_environment(nullptr);
    scene.environment.reset();
    check();
    EXPECT_FALSE(moving.set_environment(nullptr).any());
    EXPECT_FALSE(moving.turn_environment(1, vec3{1}).any());
    other.radiance.resize(7);
    EXPECT_THROW(moving.set_environment(std::make_shared<EnvironmentMap const>(other)), InputError);
    EXPECT_THROW(moving.turn_environment(1, vec3{-1}), InputError);
}

} // namespace
} // namespace gi::test
