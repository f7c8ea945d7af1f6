// The whole method by kernels, on the host and on the device, against render_slhb: with the same random numbers
// they trace the same paths, but for rounding.

#include "gi/core/error.h"
#include "gi/hit_buffers/settings.h"
#include "gi/light_paths/settings.h"
#include "gi/methods/paths/kernels/kernel_render.h"
#include "tests/slhb/kernel_rooms.h"
#include "tests/slhb/slhb_render.h"
#include "tests/support/on_device.h"

namespace gi::test {
namespace {

SlhbRun render_with_kernels(Space space, World const& world, Camera const& camera, RenderSettings const& settings)
{
    StopRequest stop;
    Report report;
    SlhbRun run{render_by_kernels(space, world, camera, settings, stop, {}, report), {}, {}};
    run.losses = report.losses();
    run.counts = report.counts();
    EXPECT_EQ(run.losses.count("path terms that were not finite, dropped"), 0u);
    return run;
}

/// Few pixels and large buffers, so that the CPU shares no endings.
RenderSettings settings_of(std::uint32_t paths, int bounces)
{
    RenderSettings s = small_settings(24, paths, bounces);
    s.of<SlhbSettings>().resolution = 64;
    s.of<PhotonSettings>().caustic_paths = 0; // kernels trace none
    return s;
}

/// Every layer's mean, and nearly every pixel's colour.
void expect_same_picture(SlhbRun const& found, SlhbRun const& expected, std::string const& what)
{
    ASSERT_EQ(found.result.paths, expected.result.paths);
    for (char const* const name : {"color", "L0", "L1", "L2", "albedo", "normal", "depth"}) {
        double const truth = mean_of(expected.result.picture, name).mean;
        EXPECT_NEAR(mean_of(found.result.picture, name).mean, truth, 0.01 * std::abs(truth) + 1e-3)
            << what << " " << name;
    }
    std::vector<float> const& a = found.result.picture.find("color")->data;
    std::vector<float> const& b = expected.result.picture.find("color")->data;
    ASSERT_EQ(a.size(), b.size());
    std::size_t differ = 0;
    for (std::size_t k = 0; k < a.size(); ++k) {
        ASSERT_TRUE(std::isfinite(a[k]));
        differ += std::abs(a[k] - b[k]) > 0.01f * (std::abs(b[k]) + 0.01f);
    }
    EXPECT_LE(differ, a.size() / 20) << what;
    double const queries = expected.counts.at("hit-buffer queries");
    EXPECT_NEAR(found.counts.at("hit-buffer queries"), queries, 0.005 * queries) << what;
}

template <Space S>
void expect_like_cpu(Scene scene, RenderSettings const& settings, std::string const& what)
{
    World const world = world_of(std::move(scene));
    SlhbRun const expected = render_small(world, room_camera(), settings);
    EXPECT_EQ(expected.counts.at("shared vertices shaded for several paths"), 0) << what;
    expect_same_picture(render_with_kernels(S, world, room_camera(), settings), expected, what);
}

template <Space S>
void check_lights()
{
    Scene light_point = room();
    add_quad(light_point, {-0.3f, 0.9f, -0.3f}, {0.6f, 0, 0}, {0, 0, 0.6f},
             add_material(light_point, emitter(vec3{10})));
    expect_like_cpu<S>(light_point, settings_of(8, 4), "area light");
    expect_like_cpu<S>(light_point, settings_of(8, 0), "area light, no bounces");

    Scene points = room();
    for (int k = 0; k < 3; ++k) {
        Light light;
        light.type = k == 2 ? LightType::spot : LightType::point;
        light.position = {0.5f - 0.4f * float(k), 0.8f, 0.1f};
        light.direction = {0, -1, 0};
        light.intensity = vec3{1 + float(k)};
        add_light(points, light);
    }
    expect_like_cpu<S>(points, settings_of(8, 6), "point lights");

    Scene open;
    add_quad(open, {-2, -1, -2}, {0, 0, 4}, {4, 0, 0}, add_material(open, lambert(vec3{0.5f})));
    add_sphere(open, {0, -0.4f, 0}, 0.6f, 3, add_material(open, lambert(vec3{0.8f, 0.5f, 0.3f})), false);
    set_environment(open, {1, 2, 3});
    Light sun;
    sun.type = LightType::directional;
    sun.direction = glm::normalize(vec3{0.3f, -1, 0.2f});
    add_light(open, sun);
    expect_like_cpu<S>(open, settings_of(8, 3), "sky and sun");
}
LIGHTWELL_TEST_BOTH(KernelRender, LightsAsOnTheCpu, check_lights);

template <Space S>
void check_schedules()
{
    Scene light_point = room();
    add_quad(light_point, {-0.3f, 0.9f, -0.3f}, {0.6f, 0, 0}, {0, 0, 0.6f},
             add_material(light_point, emitter(vec3{10})));
    RenderSettings s = settings_of(6, 5);
    s.of<SlhbSettings>().schedule = Schedule::temporal;
    expect_like_cpu<S>(light_point, s, "temporal");
    s.of<SlhbSettings>().schedule = Schedule::stored;
    s.of<SlhbSettings>().directions = "icosahedron:80";
    expect_like_cpu<S>(light_point, s, "stored");
    s.of<SlhbSettings>().most_layers = 2;
    expect_like_cpu<S>(light_point, s, "few layers");
}
LIGHTWELL_TEST_BOTH(KernelRender, SchedulesAsOnTheCpu, check_schedules);

template <Space S>
void check_cut_outs()
{
    Scene scene = room();
    Material veil = lambert(vec3{0.9f});
    veil.alpha_mode = AlphaMode::blend;
    veil.alpha = 0.5f;
    add_quad(scene, {-0.9f, 0.2f, -0.9f}, {0, 0, 1.8f}, {1.8f, 0, 0}, add_material(scene, veil));
    Light light;
    light.position = {0, 0.8f, 0};
    light.intensity = vec3{2};
    add_light(scene, light);
    expect_like_cpu<S>(scene, settings_of(8, 3), "half transparent veil");
    scene.meshes.back().alphas = {1, 0.1f, 0.9f, 0};
    for (AlphaMode const mode : {AlphaMode::blend, AlphaMode::mask}) {
        scene.materials.back().alpha_mode = mode;
        scene.materials.back().alpha = 1;
        expect_like_cpu<S>(scene, settings_of(8, 3), "veil with alphas of vertices");
    }
}
LIGHTWELL_TEST_BOTH(KernelRender, CutOutsAsOnTheCpu, check_cut_outs);

template <Space S>
void check_narrow_lobes()
{
    auto const check = [](Scene scene, int bounces, std::string const& what) {
        RenderSettings s = settings_of(8, bounces);
        expect_like_cpu<S>(std::move(scene), s, what);
    };
    Scene lamp = shiny_room();
    add_quad(lamp, {-0.3f, 0.9f, -0.3f}, {0.6f, 0, 0}, {0, 0, 0.6f}, add_material(lamp, emitter(vec3{10})));
    for (int const bounces : {0, 1, 4}) check(lamp, bounces, "lamp, bounces " + std::to_string(bounces));

    Scene sky;
    add_quad(sky, {-2, -1, -2}, {0, 0, 4}, {4, 0, 0}, add_material(sky, rough_metal(0.35f)));
    add_sphere(sky, {0, -0.4f, 0}, 0.6f, 3, add_material(sky, glass(1.3f, false)), true);
    add_quad(sky, {-1, -1, -1}, {2, 0, 0}, {0, 1, 0}, add_material(sky, glass(1.5f, true)));
    set_environment(sky, {1, 2, 3});
    check(sky, 3, "sky");

    Scene veiled = shiny_room();
    Material veil = lambert(vec3{0.9f});
    veil.alpha_mode = AlphaMode::blend;
    veil.alpha = 0.5f;
    add_quad(veiled, {-0.9f, 0.1f, -0.9f}, {0, 0, 1.8f}, {1.8f, 0, 0}, add_material(veiled, veil));
    Light light;
    light.position = {0, 0.8f, 0.3f};
    light.intensity = vec3{2};
    add_light(veiled, light);
    check(veiled, 3, "half transparent veil");
}
LIGHTWELL_TEST_BOTH(KernelRender, NarrowLobesAsOnTheCpu, check_narrow_lobes);

TEST(KernelRender, WithoutNarrowLobesAndDoubtsThereIsNoTree)
{
    auto const builds = [](Scene scene) {
        Report report;
        add_quad(scene, {-0.3f, 0.9f, -0.3f}, {0.6f, 0, 0}, {0, 0, 0.6f}, add_material(scene, emitter(vec3{10})));
        RenderSettings s = settings_of(1, 1);
        s.of<SlhbSettings>().confirm = Confirming::off;
        render_by_kernels(Space::host, world_of(scene), room_camera(), s, {}, {}, report);
        auto const times = report.times();
        bool const built =
            std::ranges::any_of(times, [](auto const& stage) { return stage.first == "build (BVH)"; });
        EXPECT_EQ(report.counts().at("exact rays") > 0, built);
        return built;
    };
    EXPECT_FALSE(builds(room()));
    EXPECT_TRUE(builds(shiny_room()));
}

template <Space S>
void check_nothing()
{
    Camera const camera = look_at({0, 0, 1}, {0, 0, 0}, 45);
    EXPECT_EQ(
        mean_of(render_with_kernels(S, world_of(Scene{}), camera, small_settings(8, 4, 2)).result.picture).mean,
        0);
    Scene sky;
    set_environment(sky, vec3{2});
    EXPECT_NEAR(
        mean_of(render_with_kernels(S, world_of(sky), camera, small_settings(8, 4, 2)).result.picture).mean, 2,
        1e-5);
    add_quad(sky, {-0.3f, -0.3f, 0}, {0.6f, 0, 0}, {0, 0.6f, 0}, add_material(sky, mirror(vec3{1})));
    sky.meshes[0].triangles.resize(1);
    SlhbRun const one = render_with_kernels(S, world_of(sky), camera, small_settings(8, 4, 2));
    EXPECT_GT(one.counts.at("exact rays"), 0);
    EXPECT_NEAR(mean_of(one.result.picture).mean, 2, 1e-4);
}
LIGHTWELL_TEST_BOTH(KernelRender, EmptySceneIsBlackAndSkyIsSkyAlsoInOneMirror, check_nothing);

template <Space S>
void check_lens()
{
    World const world = world_of(box_with_block_and_lamp());
    Camera camera = room_camera();
    camera.aperture_radius_m = 0.1;
    camera.focus_distance_m = 2;
    RenderSettings const s = settings_of(16, 2);
    SlhbRun const expected = render_small(world, camera, s);
    expect_same_picture(render_with_kernels(S, world, camera, s), expected, "lens");
    camera.aperture_radius_m = 0;
    EXPECT_NE(render_small(world, camera, s).result.picture.find("depth")->data,
              expected.result.picture.find("depth")->data);
}
LIGHTWELL_TEST_BOTH(KernelRender, LensesAreThoseOfTheCpu, check_lens);

TEST(KernelRender, WhatKernelsLackIsRefused)
{
    World const world = world_of(room());
    auto const refused = [&](Camera const& camera, RenderSettings const& s) {
        EXPECT_THROW(render_with_kernels(Space::host, world, camera, s), InputError);
    };
    refused(orthographic({0, 0, 1}, {0, 0, 0}, 1), settings_of(1, 1));
    RenderSettings cone = settings_of(1, 1), gather = settings_of(1, 1), device = settings_of(1, 1);
    cone.of<SlhbSettings>().cone = 1;
    refused(room_camera(), cone);
    gather.of<SlhbSettings>().gather = true;
    refused(room_camera(), gather);
    if (device_present()) return;
    Report report;
    device.space = Space::device;
    EXPECT_THROW(render_slhb(world, room_camera(), device, {}, {}, report), InputError);
}

} // namespace
} // namespace gi::test
