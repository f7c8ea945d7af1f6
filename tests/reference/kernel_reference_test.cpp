// The reference path tracer by kernels, on the host and on the device, against the one on Embree: with the same
// random numbers they trace the same paths, but for rounding.

#include "gi/core/error.h"
#include "gi/light_paths/settings.h"
#include "gi/methods/reference/kernels.h"
#include "gi/methods/reference/reference.h"
#include "gi/scene/generate/generate.h"
#include "gi/scene/motion/animation.h"
#include "tests/support/on_device.h"
#include "tests/support/scenes.h"
#include "tests/support/stop_at_ask.h"

#include <filesystem>
#include <glm/gtc/matrix_transform.hpp>
#include <unistd.h>

namespace gi::test {
namespace {

RenderSettings few_paths(int bounces = 4, std::uint32_t paths = 16)
{
    RenderSettings s;
    s.width = 24;
    s.height = 20;
    s.paths = paths;
    s.bounces = bounces;
    s.seed = 3;
    s.of<PhotonSettings>().caustic_paths = 0; // kernels trace none
    return s;
}

RenderResult by_kernels(Space space, World const& world, Camera const& camera, RenderSettings const& settings)
{
    Report report;
    RenderResult r = render_reference_by_kernels(space, world, camera, settings, {}, {}, report);
    EXPECT_EQ(report.losses().count("path terms that were not finite, dropped"), 0u);
    EXPECT_EQ(report.counts().at("closest-hit rays") + report.counts().at("shadow rays"), r.rays);
    return r;
}

/// Every layer's mean, the mean colour within its error, and nearly every pixel's colour.
void expect_same_picture(RenderResult const& found, RenderResult const& expected, std::string const& what)
{
    ASSERT_EQ(found.paths, expected.paths) << what;
    EXPECT_NEAR(found.rays, expected.rays, 0.005 * expected.rays) << what;
    for (char const* const name : {"color", "L0", "L1", "L2", "albedo", "normal", "depth"}) {
        double const truth = mean_of(expected.picture, name).mean;
        EXPECT_NEAR(mean_of(found.picture, name).mean, truth, 0.02 * std::abs(truth) + 1e-3)
            << what << " " << name;
    }
    Estimate const a = mean_of(found.picture), b = mean_of(expected.picture);
    EXPECT_LE(std::abs(a.mean - b.mean), 3 * std::hypot(a.sigma, b.sigma) + 1e-6) << what;
    std::vector<float> const &one = found.picture.find("color")->data,
                             &other = expected.picture.find("color")->data;
    ASSERT_EQ(one.size(), other.size());
    std::size_t differ = 0;
    for (std::size_t k = 0; k < one.size(); ++k) {
        ASSERT_TRUE(std::isfinite(one[k])) << what;
        differ += std::abs(one[k] - other[k]) > 0.01f * (std::abs(other[k]) + 0.01f);
    }
    EXPECT_LE(differ, one.size() / 20) << what;
}

template <Space S>
void expect_like_embree(World const& world, Camera const& camera, RenderSettings const& s, std::string const& what)
{
    Report report;
    RenderResult const expected = render_reference(world, camera, s, {}, {}, report);
    expect_same_picture(by_kernels(S, world, camera, s), expected, what);
}

Camera room_eye() { return look_at({0.8, 0.5, 0.9}, {-0.2, -0.4, -0.3}, 70); }

/// A room with a lamp under its ceiling.
Scene lit_room()
{
    Scene scene;
    add_box(scene, {-1, -1, -1}, {1, 1, 1}, add_material(scene, lambert(vec3{0.6f})), true);
    add_quad(scene, {-0.3f, 0.99f, -0.3f}, {0.6f, 0, 0}, {0, 0, 0.6f}, add_material(scene, emitter(vec3{10})));
    return scene;
}

template <Space S>
void check_scenes()
{
    World const atrium = world_of(generate_atrium({.bays = 2, .detail = 0.3})); // has textures, a sky and a sun
    expect_like_embree<S>(atrium, atrium.cameras.at(0), few_paths(), "atrium");
    World const world = world_of(generate_cornell());
    for (int const bounces : {0, 3})
        expect_like_embree<S>(world, world.cameras.at(0), few_paths(bounces), "cornell");
    RenderSettings s = few_paths();
    s.filter = PixelFilter::tent;
    s.share = {.first = 5, .count = 7, .merge = {}};
    expect_like_embree<S>(world, world.cameras.at(0), s, "a share of the paths");
}
LIGHTWELL_TEST_BOTH(KernelReference, GeneratedScenesAsOnEmbree, check_scenes);

template <Space S>
void check_materials()
{
    Scene scene = lit_room();
    Material metal = mirror({0.9f, 0.7f, 0.4f}), phong = lambert({0.3f, 0.2f, 0.1f});
    metal.roughness = 0.4f;
    phong.model = MaterialModel::phong;
    phong.phong_specular = vec3{0.5f};
    phong.phong_exponent = 60;
    add_quad(scene, {-0.95f, -0.8f, -0.6f}, {0, 1.2f, 0}, {0, 0, 1.2f}, add_material(scene, mirror(vec3{0.9f})));
    add_sphere(scene, {-0.1f, -0.3f, 0}, 0.3f, 3, add_material(scene, glass(1.5f, false)), true);
    add_sphere(scene, {0.5f, -0.6f, -0.4f}, 0.3f, 3, add_material(scene, metal), true);
    add_sphere(scene, {-0.4f, 0.4f, -0.5f}, 0.25f, 3, add_material(scene, phong), true);
    add_quad(scene, {-0.5f, -1, 0.5f}, {1, 0, 0}, {0, 0.8f, 0}, add_material(scene, glass(1.5f, true)));
    for (int const bounces : {0, 4}) // glass spreads the smallest difference
        expect_like_embree<S>(world_of(scene), room_eye(), few_paths(bounces), "mirror, glass, metal, phong");
}
LIGHTWELL_TEST_BOTH(KernelReference, MaterialsAsOnEmbree, check_materials);

template <Space S>
void check_panes()
{
    Scene scene = lit_room();
    Material tinted = glass(1.5f, true);
    tinted.base_color = {0.9f, 0.4f, 0.2f};
    Light light;
    light.position = {0, 0.8f, 0};
    light.intensity = vec3{2};
    add_light(scene, light);
    add_quad(scene, {-0.9f, 0.2f, -0.9f}, {0, 0, 1.8f}, {1.2f, 0, 0}, add_material(scene, tinted));
    expect_like_embree<S>(world_of(scene), room_eye(), few_paths(), "a lamp over a pane");
}
LIGHTWELL_TEST_BOTH(KernelReference, PanesAsOnEmbree, check_panes);

template <Space S>
void check_alpha()
{
    Scene scene = lit_room();
    Material veil = lambert(vec3{0.9f}), grid = lambert({0.2f, 0.4f, 0.9f});
    veil.alpha_mode = AlphaMode::blend;
    veil.alpha = 0.5f;
    grid.alpha_mode = AlphaMode::mask;
    grid.alpha = 0.4f; // below the cut-off: invisible
    add_quad(scene, {-0.9f, 0.2f, -0.9f}, {0, 0, 1.8f}, {1.8f, 0, 0}, add_material(scene, veil));
    add_box(scene, {-0.5f, -0.9f, -0.5f}, {0.5f, -0.3f, 0.5f}, add_material(scene, grid), false);
    expect_like_embree<S>(world_of(scene), room_eye(), few_paths(), "veil and invisible box");
    scene.meshes.front().alphas.assign(scene.meshes.front().positions.size(),
                                       0); // of opaque materials they mean nothing
    for (Mesh& mesh : scene.meshes)
        for (std::size_t i = 0; i < mesh.positions.size() && &mesh != &scene.meshes.front(); ++i)
            mesh.alphas.push_back(i % 2 == 0 ? 1 : 0.2f);
    expect_like_embree<S>(world_of(scene), room_eye(), few_paths(), "alphas of vertices");
}
LIGHTWELL_TEST_BOTH(KernelReference, AlphaAsOnEmbree, check_alpha);

template <Space S>
void check_lights()
{
    Scene open;
    add_quad(open, {-2, -1, -2}, {0, 0, 4}, {4, 0, 0}, add_material(open, lambert(vec3{0.5f})));
    add_sphere(open, {0, -0.4f, 0}, 0.6f, 3, add_material(open, lambert({0.8f, 0.5f, 0.3f})), false);
    Scene sky = open;
    EnvironmentMap& map = sky.environment.emplace();
    map.width = 8;
    map.height = 4;
    for (int k = 0; k < 32; ++k) map.radiance.push_back(vec3{k == 9 ? 30.0f : 0.5f, 0.4f, 0.1f * float(k % 5)});
    expect_like_embree<S>(world_of(sky), room_eye(), few_paths(), "environment map");
    for (LightType const type : {LightType::point, LightType::spot, LightType::directional}) {
        Light light;
        light.type = type;
        light.position = {0.2f, 1.5f, 0.3f};
        light.direction = glm::normalize(vec3{0.1f, -1, -0.2f});
        light.intensity = {3, 2, 1};
        add_light(open, light);
    }
    expect_like_embree<S>(world_of(open), room_eye(), few_paths(), "punctual lights");
}
LIGHTWELL_TEST_BOTH(KernelReference, LightsAsOnEmbree, check_lights);

template <Space S>
void check_cameras()
{
    World const world = world_of(generate_cornell());
    Camera camera = world.cameras.at(0);
    camera.aperture_radius_m = 0.05;
    camera.focus_distance_m = 1;
    expect_like_embree<S>(world, camera, few_paths(), "lens");
    expect_like_embree<S>(world_of(lit_room()), orthographic({0, 0, 0.9}, {0, 0, 0}, 1), few_paths(),
                          "orthographic");
}
LIGHTWELL_TEST_BOTH(KernelReference, CamerasAsOnEmbree, check_cameras);

/// In a closed room that emits E and reflects rho everywhere, each path sees E / (1 - rho) in expectation; objects
/// that lose nothing cannot be seen.
template <Space S>
void check_furnace()
{
    Scene room;
    Material wall = lambert(vec3{0.5f});
    wall.emission = vec3{0.5f};
    add_box(room, {-1, -1, -1}, {1, 1, 1}, add_material(room, wall), true);
    RenderSettings s = few_paths(1000, 256);
    Estimate e = mean_of(by_kernels(S, world_of(room), look_at({0.3, 0.1, 0.2}, {-1, -0.5, -0.7}, 70), s).picture);
    expect_estimate(e, 1, "room of albedo 0.5");
    for (Material const& m : {mirror(vec3{1}), glass(1.5f, false), glass(1.5f, true), lambert(vec3{1})}) {
        Scene scene;
        add_sphere(scene, vec3{0}, 1, 3, add_material(scene, m), false);
        set_environment(scene, vec3{1});
        e = mean_of(
            by_kernels(S, world_of(scene), look_at({0, 0, 3}, {0, 0, 0}, 50), few_paths(1000, 64)).picture);
        e.sigma = std::max(e.sigma, 2e-4 / 3);
        expect_estimate(e, 1, "lossless ball");
    }
}
LIGHTWELL_TEST_BOTH(KernelReference, FurnaceIsUniform, check_furnace);

template <Space S>
void check_little()
{
    Camera const camera = look_at({0, 0, 1}, {0, 0, 0}, 45);
    EXPECT_EQ(mean_of(by_kernels(S, world_of(Scene{}), camera, few_paths()).picture).mean, 0);
    Scene sky;
    set_environment(sky, vec3{2});
    EXPECT_NEAR(mean_of(by_kernels(S, world_of(sky), camera, few_paths()).picture).mean, 2, 1e-4);

    World one = world_of([] {
        Scene scene;
        add_quad(scene, {-0.3f, -0.3f, 0}, {0.6f, 0, 0}, {0, 0.6f, 0}, add_material(scene, emitter(vec3{1})));
        scene.meshes[0].triangles.resize(1);
        return scene;
    }());
    ASSERT_EQ(one.triangles.size(), 1u);
    expect_like_embree<S>(one, camera, few_paths(), "one triangle");
    EXPECT_GT(mean_of(by_kernels(S, one, camera, few_paths()).picture).mean, 0.05);
}
LIGHTWELL_TEST_BOTH(KernelReference, EmptyScenesAndOneTriangle, check_little);

/// Frames of what moves and changes, in several views, with motion vectors.
template <Space S>
void check_frames()
{
    Scene scene = lit_room(), object;
    add_sphere(object, {0.3f, -0.4f, 0.2f}, 0.3f, 2, add_material(object, mirror(vec3{0.8f})), true);
    append(scene, std::move(object), "object", dmat4(1));
    scene.nodes.back().driven = true;
    auto const shared = std::make_shared<Scene const>(std::move(scene));
    Report report, expected_report;
    MovingWorld world(shared, 0, report);
    auto const found = start_reference_kernel_frames(S, world, few_paths(), report);
    auto const expected = start_reference_frames(world, room_eye(), few_paths(), expected_report);
    auto const next = [&](Changes const& changes, char const* what) {
        found->changed(changes);
        expected->changed(changes);
        FrameView const views[] = {{room_eye(), 24, 20}, {look_at({-0.8, 0.2, 0.8}, {0, -0.4, 0}, 60), 16, 16}};
        auto const a = found->views(views, 8, VertexSharing::none, {}),
                   b = expected->views(views, 8, VertexSharing::none, {});
        for (std::size_t k = 0; k < 2; ++k) {
            expect_same_picture(a[k], b[k], what);
            std::vector<float> const &motion = a[k].picture.find("motion")->data,
                                     &truth = b[k].picture.find("motion")->data;
            std::size_t differ = 0;
            for (std::size_t i = 0; i < motion.size(); ++i) differ += std::abs(motion[i] - truth[i]) > 1e-2f;
            EXPECT_LE(differ, motion.size() / 100) << what;
        }
    };
    auto const place = [&](dvec3 at) {
        Pose pose = evaluate_pose(*shared, 0);
        pose.world_from_node.back() = glm::translate(dmat4(1), at) * pose.world_from_node.back();
        return world.advance(pose);
    };
    next({}, "at first");
    next(place({-0.4, 0.3, 0}), "moved");
    Material veil = lambert(vec3{0.9f});
    veil.alpha_mode = AlphaMode::blend;
    veil.alpha = 0.5f;
    next(world.set_material(2, veil), "half transparent");
    next(place({-0.1, 0.6, -0.3}), "moved on");
    expect_same_picture(found->frame(room_eye(), {}, {}), expected->frame(room_eye(), {}, {}), "a frame");
    auto const moments = [&](FrameRenderer& frames) { // as the shutter sees them
        return frames.frame(room_eye(), {}, {}, [&](std::uint32_t pass) {
            return Moment{place({-0.02 * pass, 0.3, 0}), room_eye()};
        });
    };
    RenderResult const blurred = moments(*found);
    expected->changed(place({0, 0.3, 0}));
    expect_same_picture(blurred, moments(*expected), "many moments");
}
LIGHTWELL_TEST_BOTH(KernelReference, FramesFollowWhatMoves, check_frames);

/// With a budget, pixels take indirect light from neighbours in turn.
template <Space S>
void check_budget()
{
    Report report;
    MovingWorld const world(std::make_shared<Scene const>(lit_room()), 0, report);
    RenderSettings s = few_paths(4, 256);
    s.budget_s = 0.2;
    auto const frames = start_reference_kernel_frames(S, world, s, report);
    frames->frame(room_eye(), {}, {});
    RenderResult const found = frames->frame(room_eye(), {}, {});
    EXPECT_GT(found.paths, 0u);
    double const truth = mean_of(by_kernels(S, world.world(), room_eye(), few_paths(4, 256)).picture).mean;
    EXPECT_NEAR(mean_of(found.picture).mean, truth, 0.1 * truth);
}
LIGHTWELL_TEST_BOTH(KernelReference, BudgetsOfFrames, check_budget);

/// Passes end between launches; a resumed state gives the same bits.
template <Space S>
void check_interruptions()
{
    World const world = world_of(lit_room());
    RenderSettings s = few_paths(4, 60);
    s.width = 60;
    s.height = 50;
    Picture const whole = by_kernels(S, world, room_eye(), s).picture;
    s.checkpoint =
        std::filesystem::temp_directory_path() / ("lightwell_kernels_" + std::to_string(getpid()) + ".state");
    int interrupted = 0;
    for (std::uint64_t asks = 1; interrupted < 3 && asks < 100'000; asks *= 2) {
        s.resume = false;
        StopAtAsk const stop(asks);
        Report report;
        try {
            RenderResult const part = render_reference_by_kernels(S, world, room_eye(), s, stop, {}, report);
            if (part.end != RenderEnd::interrupted) break;
            ASSERT_TRUE(part.resumable);
            ++interrupted;
        } catch (Interrupted const&) { // before there was a path
            continue;
        }
        s.resume = true;
        Picture const found = by_kernels(S, world, room_eye(), s).picture;
        for (Layer const& layer : whole.layers)
            EXPECT_EQ(found.find(layer.name.c_str())->data, layer.data) << layer.name;
    }
    EXPECT_GT(interrupted, 0);
    std::filesystem::remove(s.checkpoint);
}
LIGHTWELL_TEST_BOTH(KernelReference, InterruptedRendersGoOn, check_interruptions);

TEST(KernelReference, NeedsADevice)
{
    if (device_present()) GTEST_SKIP() << "SKIPPED: there is a CUDA device";
    RenderSettings s = few_paths();
    s.space = Space::device;
    Report report;
    EXPECT_THROW(render_reference(world_of(Scene{}), room_eye(), s, {}, {}, report), InputError);
}

} // namespace
} // namespace gi::test
