// The same seed gives the same bits, however the work is divided;
// another seed gives another sample of the same mean.

#include "gi/core/error.h"
#include "gi/light_paths/settings.h"
#include "gi/methods/reference/reference.h"
#include "gi/render/checkpoint.h"
#include "tests/support/scenes.h"
#include "tests/support/stop_at_ask.h"

#include <cstdlib>
#include <cstring>
#include <fstream>
#include <gtest/gtest.h>

namespace gi::test {
namespace {

/// @param with_lamp  whose caustics are photons
World room(bool with_lamp = true)
{
    Scene scene;
    add_box(scene, {-1, -1, -1}, {1, 1, 1}, add_material(scene, lambert({0.7f, 0.6f, 0.5f})), true);
    add_quad(scene, {-0.3f, 0.99f, -0.3f}, {0.6f, 0, 0}, {0, 0, 0.6f}, add_material(scene, emitter(vec3{6})));
    add_sphere(scene, {-0.4f, -0.5f, 0}, 0.4f, 3, add_material(scene, glass(1.5f, false)), true);
    add_sphere(scene, {0.5f, -0.6f, -0.2f}, 0.35f, 3, add_material(scene, mirror(vec3{0.9f})), true);
    Light lamp;
    lamp.position = {0.1f, 0.7f, 0.2f};
    lamp.intensity = vec3{0.5f};
    if (with_lamp) add_light(scene, lamp);
    return world_of(scene);
}

RenderSettings settings()
{
    RenderSettings s;
    s.width = 40;
    s.height = 30;
    s.paths = 32;
    s.seed = 3;
    s.of<PhotonSettings>().caustic_paths = 2000;
    return s;
}

Camera eye() { return look_at({0, 0, 0.95}, {0, -0.2, 0}, 80); }

RenderResult render(World const& world, RenderSettings const& s)
{
    Report report;
    return render_reference(world, eye(), s, {}, {}, report);
}

/// Interrupted after the first pass.
RenderResult begin(World const& world, RenderSettings const& s, Report& report)
{
    StopRequest stop;
    return render_reference(
        world, eye(), s, stop, [&](RenderStatus const&) { stop.request(); }, report);
}
RenderResult begin(World const& world, RenderSettings const& s)
{
    Report report;
    return begin(world, s, report);
}

void expect_same_bits(Picture const& a, Picture const& b)
{
    ASSERT_EQ(a.layers.size(), b.layers.size());
    for (std::size_t i = 0; i < a.layers.size(); ++i)
        EXPECT_EQ(0, std::memcmp(a.layers[i].data.data(), b.layers[i].data.data(), 4 * a.layers[i].data.size()))
            << a.layers[i].name;
}

TEST(Determinism, ThreadsDoNotMatter)
{
    World const world = room();
    RenderSettings s = settings();
    s.width = 333; // many tiles, the last ones cut
    s.height = 205;
    s.paths = 4;
    s.threads = 1;
    Picture const one = render(world, s).picture;
    s.threads = 2;
    expect_same_bits(one, render(world, s).picture);
}

TEST(Determinism, ResumedEqualsUninterrupted)
{
    World const world = room();
    std::filesystem::path const state =
        std::filesystem::temp_directory_path() / ("lightwell_resume_" + std::to_string(getpid()) + ".state");
    RenderSettings s = settings();
    Picture const whole = render(world, s).picture;

    s.checkpoint = state;
    RenderResult const part = begin(world, s);
    EXPECT_EQ(part.end, RenderEnd::interrupted);
    EXPECT_LT(part.paths, s.paths);
    ASSERT_TRUE(std::filesystem::exists(state));

    RenderSettings other = s;
    other.resume = true;
    other.seed = 4;
    EXPECT_THROW(render(world, other), InputError);
    s.resume = true;
    RenderResult const rest = render(world, s);
    expect_same_bits(whole, rest.picture);
    EXPECT_FALSE(rest.resumable);
    EXPECT_GT(rest.rays, 2.0 * s.width * s.height * s.paths) << "those before the interruption count, too";

    std::ofstream(state) << "not a checkpoint";
    EXPECT_THROW(render(world, s), InputError);
    std::filesystem::remove(state);
}

/// A pass may take longer than a user wants to wait: after a stop, the paths of its finished tiles are kept.
TEST(Determinism, APassIsInterruptedBetweenItsTiles)
{
    World const world = room(false); // photons would end a pass after each path
    std::filesystem::path const state =
        std::filesystem::temp_directory_path() / ("lightwell_tiles_" + std::to_string(getpid()) + ".state");
    RenderSettings s = settings();
    s.width = 77; // the last tiles are cut
    s.height = 45;
    s.paths = 12;
    Picture const whole = render(world, s).picture;
    s.checkpoint = state;
    bool is_met = false;
    for (std::uint64_t asks = 1; !is_met && asks < 100'000; asks *= 2) {
        StopAtAsk stop;
        auto const in_the_next_pass = [&](RenderStatus const&) { stop.request_after(asks); };
        Report report;
        s.resume = false;
        if (render_reference(world, eye(), s, stop, in_the_next_pass, report).end != RenderEnd::interrupted) break;
        is_met = std::filesystem::file_size(state) > checkpoint_bytes(s.width, s.height);
        s.resume = true;
        RenderResult const rest = render(world, s);
        expect_same_bits(whole, rest.picture);
        EXPECT_EQ(rest.paths, s.paths);
        s.paths = 1; // less than the state has: its pass is ended all the same
        EXPECT_GE(render(world, s).paths, 1u);
        s.paths = 12;
    }
    EXPECT_TRUE(is_met);
    std::filesystem::remove(state);
}

/// So is a first pass, however little it has.
TEST(Determinism, AFirstPassIsInterruptedBetweenItsTiles)
{
    World const world = room(false); // photons would end a pass after each path
    std::filesystem::path const state =
        std::filesystem::temp_directory_path() / ("lightwell_first_" + std::to_string(getpid()) + ".state");
    RenderSettings s = settings();
    s.width = 90;
    s.height = 60;
    s.paths = 2;
    Picture const whole = render(world, s).picture;
    s.checkpoint = state;
    bool is_met = false;
    for (std::uint64_t asks = 1; !is_met && asks < 100'000; asks += 1 + asks / 4) {
        StopAtAsk const stop(asks);
        s.resume = false;
        Report report;
        RenderResult part;
        try {
            part = render_reference(world, eye(), s, stop, {}, report);
        } catch (Interrupted const&) { // while the BVH was built
            continue;
        }
        if (part.paths > 0) break;
        is_met = true;
        EXPECT_EQ(part.end, RenderEnd::interrupted);
        ASSERT_TRUE(part.resumable);
        for (Layer const& layer : part.picture.layers)
            for (float const v : layer.data) ASSERT_TRUE(std::isfinite(v)) << layer.name;
        s.resume = true;
        expect_same_bits(whole, render(world, s).picture);
    }
    EXPECT_TRUE(is_met);
    std::filesystem::remove(state);
}

TEST(Determinism, AStateThatCannotBeWrittenCostsNoPicture)
{
    RenderSettings s = settings();
    s.checkpoint = std::filesystem::temp_directory_path() / "lightwell_no_folder" / "x.state";
    Report report;
    RenderResult const part = begin(room(), s, report);
    EXPECT_EQ(part.end, RenderEnd::interrupted);
    EXPECT_FALSE(part.resumable);
    EXPECT_GT(part.paths, 0u);
    EXPECT_FALSE(part.picture.layers.empty());
    EXPECT_EQ(report.losses().count("checkpoints that could not be written"), 1u);
}

/// The picture need not wait for it.
TEST(Determinism, StateOfAPictureByRowsIsSavedByItsReader)
{
    std::filesystem::path const state =
        std::filesystem::temp_directory_path() / ("lightwell_by_rows_" + std::to_string(getpid()) + ".state");
    RenderSettings s = settings();
    Picture const whole = render(room(), s).picture;
    s.checkpoint = state;
    s.by_rows = true;
    RenderResult const part = begin(room(), s);
    EXPECT_FALSE(part.resumable);
    EXPECT_FALSE(std::filesystem::exists(state));
    ASSERT_TRUE(part.save_state);
    part.save_state(DiskWait::no);
    EXPECT_TRUE(part.rows);
    s.resume = true;
    RenderResult const rest = render(room(), s);
    EXPECT_TRUE(rest.save_state) << "its picture may not be saved";
    StopRequest stop;
    expect_same_bits(whole, rest.rows.whole(&stop));
    stop.request();
    EXPECT_THROW(rest.rows.whole(&stop), Interrupted);
    std::filesystem::remove(state);

    s.checkpoint = std::filesystem::temp_directory_path() / "lightwell_no_folder" / "x.state";
    EXPECT_THROW(begin(room(), s).save_state(DiskWait::yes), InputError);
}

/// Whatever changes the picture makes a state unusable.
TEST(Determinism, StatesOfOtherScenesAreRefused)
{
    auto const scene = [](vec3 color, vec2 offset) {
        Scene s;
        add_quad(s, {-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, add_material(s, lambert(vec3{1})));
        s.meshes[0].colors.assign(4, color);
        s.materials[0].normal_map.offset = offset;
        set_environment(s, vec3{1});
        return world_of(s);
    };
    std::filesystem::path const state =
        std::filesystem::temp_directory_path() / ("lightwell_other_" + std::to_string(getpid()) + ".state");
    RenderSettings s = settings();
    s.checkpoint = state;
    ASSERT_TRUE(begin(scene({1, 0, 0}, {0, 0}), s).resumable);
    s.resume = true;
    EXPECT_THROW(render(scene({0, 1, 0}, {0, 0}), s), InputError);
    EXPECT_THROW(render(scene({1, 0, 0}, {0.5f, 0}), s), InputError);
    EXPECT_NO_THROW(render(scene({1, 0, 0}, {0, 0}), s));
    std::filesystem::remove(state);
}

/// Without bounces there is still all light that came by mirrors alone before and after its one scattering.
TEST(Determinism, BouncesDoNotCountMirrors)
{
    Scene scene;
    add_quad(scene, {-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, add_material(scene, lambert(vec3{0.5f})));
    add_quad(scene, {-1, 0, -1}, {2, 0, 0}, {0, 2, 0}, add_material(scene, mirror(vec3{1})));
    add_quad(scene, {-0.2f, 1, 0.2f}, {0, 0, 0.4f}, {0.4f, 0, 0}, add_material(scene, emitter(vec3{9}, true)));
    RenderSettings s = settings();
    s.paths = 512;
    Camera const camera = orthographic({0, 3, 0.5}, {0, 0, 0.5}, 0.5);
    auto const direct = [&](int bounces) {
        s.bounces = bounces;
        Report report;
        return mean_of(render_reference(world_of(scene), camera, s, {}, {}, report).picture, "L1");
    };
    Estimate const none = direct(0), many = direct(8);
    EXPECT_NEAR(none.mean, many.mean, 1e-6 * many.mean) << "the same paths";
}

TEST(Determinism, AResumedRenderKnowsItsErrorBeforeItStops)
{
    World const world = room();
    RenderSettings s = settings();
    s.paths = 1u << 20;
    s.until_relmse = 4e-3;
    s.checkpoint =
        std::filesystem::temp_directory_path() / ("lightwell_until_" + std::to_string(getpid()) + ".state");
    s.budget_s = 0;
    ASSERT_EQ(begin(world, s).end, RenderEnd::interrupted);
    s.resume = true;
    RenderResult const r = render(world, s);
    EXPECT_EQ(r.end, RenderEnd::error_target);
    EXPECT_GT(r.relmse, 0);
    EXPECT_LT(r.relmse, 4e-3);
}

TEST(Determinism, SeedsDifferWithinTheirVariance)
{
    World const world = room();
    RenderSettings s = settings();
    s.paths = 64;
    Picture const a = render(world, s).picture;
    s.seed = 99;
    Picture const b = render(world, s).picture;
    Estimate const ea = mean_of(a), eb = mean_of(b);
    EXPECT_NE(ea.mean, eb.mean);
    EXPECT_LT(std::abs(ea.mean - eb.mean), 4 * std::hypot(ea.sigma, eb.sigma));
}

TEST(Determinism, StopsAtErrorTargetAndBudget)
{
    World const world = room();
    RenderSettings s = settings();
    s.paths = 1u << 20;
    s.until_relmse = 0.05;
    RenderResult const target = render(world, s);
    EXPECT_EQ(target.end, RenderEnd::error_target);
    EXPECT_LT(target.relmse, 0.05);
    s.until_relmse = 0;
    s.budget_s = 0.2;
    RenderResult const timed = render(world, s);
    EXPECT_EQ(timed.end, RenderEnd::budget);
    EXPECT_LT(timed.seconds, 5.0); // its passes take milliseconds
}

TEST(Determinism, LayersAddUp)
{
    Picture const p = render(room(), settings()).picture;
    for (std::size_t i = 0; i < p.pixels(); ++i) {
        vec3 const sum = rgb(*p.find("L0"), i) + rgb(*p.find("L1"), i) + rgb(*p.find("L2"), i);
        EXPECT_LT(glm::length(rgb(*p.find("color"), i) - sum), 1e-5f * (1 + glm::length(sum)));
    }
}

} // namespace
} // namespace gi::test
