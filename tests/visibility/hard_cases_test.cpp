// Inputs that have broken renderers: every method vpl_* ends, with finite pictures and with what it lost counted.

#include "gi/core/error.h"
#include "gi/render/checkpoint.h"
#include "tests/support/stop_at_ask.h"
#include "tests/visibility/visibility_render.h"

#include <numeric>
#include <unistd.h>

namespace gi::test {
namespace {

void expect_black(World const& world)
{
    for (VisibilityKind const kind : kKinds) {
        Picture const p =
            render_visibility(kind, world, look_at({0, 0.5, 3}, {0, 0, 0}, 50), small_picture(8, 2, 3))
                .result.picture;
        for (float const v : p.find("color")->data) EXPECT_EQ(v, 0) << int(kind);
    }
}

TEST(VisibilityHardCases, EmptyScenesAndScenesWithoutLightsAreBlack)
{
    expect_black(world_of({}));
    Scene dark;
    add_box(dark, {-1, -1, -1}, {1, 1, 1}, add_material(dark, lambert(vec3{0.5f})), false);
    expect_black(world_of(dark));
}

TEST(VisibilityHardCases, SkyAloneIsSeen)
{
    Scene scene;
    set_environment(scene, vec3{0.25f});
    World const world = world_of(scene);
    for (VisibilityKind const kind : kKinds) {
        Picture const p = render_visibility(kind, world, look_at({0, 0, 3}, {0, 0, 0}, 50), small_picture(8, 2, 3))
                              .result.picture;
        for (float const v : p.find("color")->data) EXPECT_NEAR(v, 0.25f, 1e-5f) << int(kind);
    }
}

TEST(VisibilityHardCases, LampOutsideAClosedBoxLightsNothingInIt)
{
    Scene scene;
    add_box(scene, {-1, -1, -1}, {1, 1, 1}, add_material(scene, lambert(vec3{0.6f})), true);
    add_quad(scene, {-1, 2, 1}, {2, 0, 0}, {0, 0, -2}, add_material(scene, emitter(vec3{9}, true)));
    World const world = world_of(scene);
    RenderSettings const s = small_picture(16, 8, 3);
    for (VisibilityKind const kind : kKinds) {
        double const mean = mean_of(render_visibility(kind, world, in_the_box(), s).result.picture, "L2").mean;
        if (kind == VisibilityKind::exact) {
            EXPECT_EQ(mean, 0);
        }
        // Surfaces outside face away from those inside, but for the lamp's own black quad:
        // nothing leaks even here.
        EXPECT_LT(mean, 1e-6) << int(kind);
    }
}

TEST(VisibilityHardCases, ResumedRendersHaveTheBitsOfUninterruptedOnes)
{
    World const world = world_of(box_with_block());
    std::filesystem::path const state =
        std::filesystem::temp_directory_path() / ("lightwell_vpl_" + std::to_string(getpid()) + ".state");
    for (VisibilityKind const kind : kKinds) {
        RenderSettings s = small_picture(16, 6, 3);
        Picture const whole = render_visibility(kind, world, in_the_box(), s).result.picture;
        s.checkpoint = state;
        StopRequest stop;
        Report report;
        auto const after_the_first_pass = [&](RenderStatus const&) { stop.request(); };
        RenderResult const part =
            render_with_virtual_lights(kind, world, in_the_box(), s, stop, after_the_first_pass, report);
        ASSERT_TRUE(part.resumable) << int(kind);
        EXPECT_LT(part.paths, s.paths);
        s.resume = true;
        RenderResult const resumed = render_visibility(kind, world, in_the_box(), s).result;
        EXPECT_EQ(resumed.paths, s.paths);
        for (Layer const& layer : whole.layers)
            EXPECT_EQ(resumed.picture.find(layer.name)->data, layer.data) << int(kind) << " " << layer.name;
        std::filesystem::remove(state);
    }
}

/// A pass may take longer than a person waits: what its tiles have is kept.
TEST(VisibilityHardCases, APassIsInterruptedBetweenItsTiles)
{
    World const world = world_of(box_with_block());
    std::filesystem::path const state =
        std::filesystem::temp_directory_path() / ("lightwell_vpl_tiles_" + std::to_string(getpid()) + ".state");
    for (VisibilityKind const kind : kKinds) {
        RenderSettings s = small_picture(50, 2, 3);
        s.of<VirtualLightSettings>().light_paths = 64;
        Picture const whole = render_visibility(kind, world, in_the_box(), s).result.picture;
        s.checkpoint = state;
        bool is_met = false;
        for (std::uint64_t asks = 1; !is_met && asks < 100'000; asks += 1 + asks / 2) {
            StopAtAsk stop;
            auto const in_the_next_pass = [&](RenderStatus const&) { stop.request_after(asks); };
            Report report;
            s.resume = false;
            RenderResult const part =
                render_with_virtual_lights(kind, world, in_the_box(), s, stop, in_the_next_pass, report);
            if (part.end != RenderEnd::interrupted) break;
            is_met = std::filesystem::file_size(state) > checkpoint_bytes(s.width, s.height);
        }
        ASSERT_TRUE(is_met) << int(kind);
        s.resume = true;
        RenderResult const resumed = render_visibility(kind, world, in_the_box(), s).result;
        EXPECT_EQ(resumed.paths, s.paths);
        for (Layer const& layer : whole.layers)
            EXPECT_EQ(resumed.picture.find(layer.name)->data, layer.data) << int(kind) << " " << layer.name;
        std::filesystem::remove(state);
    }
}

TEST(VisibilityHardCases, FarFromTheOriginIsAsNear)
{
    Scene near = box_with_block(), far = box_with_block();
    dvec3 const away{4e6, -2e6, 1e6};
    for (Node& n : far.nodes) n.translation += away;
    Camera eye = in_the_box();
    Camera const there = look_at(dvec3{0.8, 0.5, 0.9} + away, dvec3{-0.1, -0.6, -0.2} + away, 60);
    World const here = world_of(near), moved = world_of(far);
    RenderSettings const s = small_picture(16, 8, 2);
    for (VisibilityKind const kind : kKinds) {
        double const a = mean_of(render_visibility(kind, here, eye, s).result.picture, "L2").mean,
                     b = mean_of(render_visibility(kind, moved, there, s).result.picture, "L2").mean;
        EXPECT_NEAR(a, b, 0.01 * a) << int(kind);
    }
}

TEST(VisibilityHardCases, DegenerateTrianglesDoNoHarm)
{
    Scene scene = box_with_block();
    int const grey = add_material(scene, lambert(vec3{0.5f}));
    add_quad(scene, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}, grey);                  // a point
    add_quad(scene, {0.5f, 0, 0}, {0.3f, 0, 0}, {0.6f, 0, 0}, grey);         // a line
    add_quad(scene, {0.5f, -0.5f, 0}, {0.3f, 0, 0}, {0.3f, 1e-7f, 0}, grey); // a sliver
    add_quad(scene, {0.5f, 0.2f, 0}, {std::nanf(""), 0, 0}, {0, 1, 0}, grey);
    World const clean = world_of(box_with_block()), world = world_of(scene);
    RenderSettings const s = small_picture(16, 8, 2);
    for (VisibilityKind const kind : kKinds) {
        double const a = mean_of(render_visibility(kind, clean, in_the_box(), s).result.picture, "L2").mean,
                     b = mean_of(render_visibility(kind, world, in_the_box(), s).result.picture, "L2").mean;
        EXPECT_NEAR(a, b, 0.02 * a) << int(kind);
    }
}

TEST(VisibilityHardCases, MasksLetVirtualLightThrough)
{
    // A curtain of alpha 0.5 across the box: exact visibility agrees with the reference.
    Scene scene = box_with_block();
    Material veil = lambert(vec3{0});
    veil.alpha = 0.5f;
    veil.alpha_mode = AlphaMode::blend;
    add_quad(scene, {-1, -1, 0.4f}, {2, 0, 0}, {0, 1.9f, 0}, add_material(scene, veil));
    World const world = world_of(scene);
    RunningMean const truth = reference_over_seeds(world, in_the_box(), small_picture(16, 256, 2), 8, "L2");
    RunningMean const m =
        mean_over_seeds(VisibilityKind::exact, world, in_the_box(), small_picture(16, 24, 2), 12, "L2");
    EXPECT_NEAR(m.mean(), truth.mean(), 3.5 * std::hypot(m.sigma(), truth.sigma()));
    RenderSettings const s = small_picture(16, 16, 2);
    double const exact =
        mean_of(render_visibility(VisibilityKind::exact, world, in_the_box(), s).result.picture, "L2").mean;
    for (VisibilityKind const kind : {VisibilityKind::slhb, VisibilityKind::imperfect})
        EXPECT_NEAR(mean_of(render_visibility(kind, world, in_the_box(), s).result.picture, "L2").mean, exact,
                    0.1 * exact)
            << int(kind);
}

TEST(VisibilityHardCases, WhatIsBoundedAndWhatNoAxisLeavesIsCounted)
{
    World const world = world_of(box_with_block());
    RenderSettings s = small_picture(16, 4, 2);
    s.of<VirtualLightSettings>().near_m = 0.2f;
    VisibilityRun const exact = render_visibility(VisibilityKind::exact, world, in_the_box(), s);
    EXPECT_GT(exact.counts.at("virtual lights"), 64 * 4);
    EXPECT_GT(exact.counts.at("connections bounded, the rest computed by camera paths"), 0);
    EXPECT_GT(exact.counts.at("connections to virtual lights"),
              10 * exact.counts.at("connections bounded, the rest computed by camera paths"));
    EXPECT_TRUE(exact.losses.empty());
    VisibilityRun const slhb =
        render_visibility(VisibilityKind::slhb, world, in_the_box(), small_picture(16, 4, 2));
    EXPECT_GT(slhb.losses.at("connections without a suitable axis, taken as unoccluded").count, 0u);
}

TEST(VisibilityHardCases, MapsThatCannotBeAreRefused)
{
    World const world = world_of(box_with_block());
    RenderSettings s = small_picture(8, 1, 1);
    s.of<VirtualLightSettings>().point_map = 100;
    EXPECT_THROW(render_visibility(VisibilityKind::imperfect, world, in_the_box(), s), InputError);
    s.of<VirtualLightSettings>().point_map = 64;
    s.of<VirtualLightSettings>().points = 0;
    EXPECT_THROW(render_visibility(VisibilityKind::imperfect, world, in_the_box(), s), InputError);
}

} // namespace
} // namespace gi::test
