// The same changes and orders give the same pixels; what is set is set; what cannot be leaves all as it was.

#include "gi/methods/vpl/settings.h"
#include "viewer/engine/render_session.h"

#include "gi/core/error.h"
#include "gi/kernel/device.h"
#include "gi/metrics/metrics.h"
#include "gi/scene/generate/generate.h"
#include "tests/support/scenes.h"
#include "tests/support/stop_at_ask.h"
#include "viewer/engine/picking.h"

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>
#include <numeric>

namespace viewer::test {
namespace {

using gi::test::add_material, gi::test::add_box, gi::test::add_quad, gi::test::lambert, gi::test::emitter;

/// A room with a block at a node of its own, a lamp of triangles and one of none.
std::shared_ptr<gi::Scene const> scene_of(std::string const& name, gi::Report&)
{
    if (name != "room") throw gi::InputError("no scene '" + name + "'", "there is only one", "use room");
    gi::Scene scene;
    add_box(scene, {-1, -1, -1}, {1, 1, 1}, add_material(scene, lambert(gi::vec3{0.6f})), true);
    add_quad(scene, {-0.3f, 0.99f, -0.3f}, {0.6f, 0, 0}, {0, 0, 0.6f}, add_material(scene, emitter(gi::vec3{10})));
    gi::Light lamp;
    lamp.position = {0.5f, 0.5f, 0.5f};
    gi::test::add_light(scene, lamp);
    gi::Scene block;
    add_box(block, {-0.4f, -1, -0.4f}, {0.3f, 0, 0.2f}, add_material(block, lambert(gi::vec3{0.2f, 0.6f, 0.2f})),
            false);
    append(scene, std::move(block), "block", gi::dmat4(1));
    return std::make_shared<gi::Scene const>(std::move(scene));
}

constexpr std::uint32_t kBlock = 2; // material

gi::Camera eye(double aside = 0)
{
    gi::Camera camera = gi::look_at({-0.6, 0.1, 0.9}, {0.1, -0.4, 0}, 60);
    camera.world_from_camera = camera.world_from_camera * glm::translate(gi::dmat4(1), gi::dvec3{aside, 0, 0});
    return camera;
}

FrameCommand command(std::uint64_t frame, double aside = 0, bool stereo = false)
{
    FrameCommand o;
    o.frame = frame;
    o.views.push_back({"left", eye(aside), 40, 30, -1});
    if (stereo) o.views.push_back({"right", eye(aside + 0.06), 40, 30, 0});
    return o;
}

/// As command(), of a quarter of the pixels, for many paths.
FrameCommand small_command(std::uint64_t frame)
{
    FrameCommand o = command(frame, 0, true);
    for (ViewCommand& v : o.views) v.width = 20, v.height = 15;
    return o;
}

RenderSession started(gi::Report& report)
{
    RenderSession s(scene_of, 0, report);
    s.apply({"scene", "room"});
    s.apply({"method", "slhb"});
    s.apply({"resolution", 48});
    s.apply({"directions", "icosahedron:80"});
    return s;
}

std::vector<float> const& color(SessionFrame const& f, std::size_t view = 0)
{
    return f.views[view].picture.find("color")->data;
}

double mean(std::vector<float> const& v)
{
    double sum = 0;
    for (float const x : v) sum += double(x);
    return sum / double(v.size());
}

double relmse(std::vector<float> const& a, std::vector<float> const& b)
{
    return gi::measure_errors(a, b, 3).relmse;
}

TEST(RenderSession, TheSameOrdersGiveTheSamePixels)
{
    std::vector<std::vector<float>> runs[2];
    for (auto& run : runs) {
        gi::Report report;
        RenderSession s = started(report);
        for (std::uint64_t f = 0; f < 8; ++f) {
            if (f == 2) s.apply({"light.0.intensity", {3, 2, 1}});
            if (f == 3) s.apply({"object.block.position", {0.2, 0.1, 0}});
            if (f == 5) s.apply({"material.2.base_color", {0.7, 0.1, 0.1}});
            if (f == 6) s.apply({"bounces", 1});
            run.push_back(color(s.render(command(f, 0.01 * double(f), true), {}), 1));
        }
    }
    for (std::size_t f = 0; f < 8; ++f) EXPECT_EQ(runs[0][f], runs[1][f]) << "frame " << f;
    EXPECT_GT(relmse(runs[0][2], runs[0][1]), 1e-3); // changes do show
    EXPECT_GT(relmse(runs[0][3], runs[0][2]), 1e-3);
    EXPECT_GT(relmse(runs[0][5], runs[0][4]), 1e-3);
}

/// A recording has the paths that were traced, not those that were asked for before a stop.
TEST(RenderSession, AFrameThatWasStoppedCanBeRenderedAgain)
{
    gi::Report report;
    RenderSession stopped = started(report), again = started(report);
    for (std::uint64_t frame = 0; frame < 4; ++frame) {
        FrameCommand wanted = command(frame);
        wanted.paths = 40;
        gi::StopRequest stop;
        if (frame % 2 == 1) stop.request();
        SessionFrame const seen = stopped.render(wanted, stop);
        EXPECT_EQ(seen.paths, frame % 2 == 1 ? 1 : 40);
        FrameCommand recorded = wanted;
        recorded.paths = seen.paths;
        EXPECT_EQ(color(again.render(recorded, {})), color(seen)) << frame;
    }
}

void expect_same(SessionFrame const& a, SessionFrame const& b, std::uint64_t frame)
{
    ASSERT_EQ(a.views.size(), b.views.size());
    for (std::size_t k = 0; k < a.views.size(); ++k) EXPECT_EQ(color(a, k), color(b, k)) << frame << ", view " << k;
    EXPECT_EQ(a.still_frames, b.still_frames) << frame;
}

/// Wherever it was stopped: the frames that follow are those of a session that never began it.
TEST(RenderSession, AFrameThatIsGivenUpLeavesNoTrace)
{
    for (bool const stereo : {false, true}) {
        gi::Report report;
        RenderSession asked = started(report), never = started(report);
        for (RenderSession* const s : {&asked, &never}) s->apply({"method", "paths"});
        int given_up = 0, whole = 0;
        for (std::uint64_t frame = 0; frame < 9; ++frame) {
            // It walks, stands and refines at full size, and walks again.
            bool const stands = frame >= 3 && frame < 7;
            FrameCommand wanted = command(frame, 0.01 * double(stands ? 3 : frame), stereo);
            wanted.light_scale = wanted.surface_scale = stands ? 1 : 0.5;
            wanted.paths = stands ? 2 : 1;
            bool ends = false;
            for (std::uint64_t ask = 1; stands && !ends; ask = ask * 3 / 2 + 1) {
                gi::test::StopAtAsk const stop(ask);
                try {
                    SessionFrame const seen = asked.render(wanted, stop, OnStop::give_up);
                    ends = true; // not asked so often
                    EXPECT_EQ(seen.paths, 2);
                    expect_same(seen, never.render(wanted, {}), frame);
                } catch (gi::Interrupted const&) {
                    ++given_up;
                    EXPECT_LE(stop.asks(), ask + gi::test::asks_until_noticed());
                }
            }
            whole += ends;
            if (stands) continue;
            expect_same(asked.render(wanted, {}), never.render(wanted, {}), frame);
        }
        EXPECT_EQ(whole, 4);
        EXPECT_GE(given_up, 40) << "in filters, too";
    }
}

/// Nor that of a view whose hidden pixels are kept for one size at a time.
TEST(RenderSession, AFrameThatIsGivenUpLeavesNoTraceOfItsHiddenPixels)
{
    gi::Report report;
    RenderSession asked = started(report), never = started(report);
    for (RenderSession* const s : {&asked, &never}) {
        s->apply({"method", "paths"});
        s->apply({"first_surfaces", false});
        s->apply(hidden_change("left", {{{-9, 0.1f}, {9, 0.1f}, {9, 9}, {-9, 9}}, {0, 1, 2, 0, 2, 3}})); // upper part
    }
    for (std::uint64_t frame = 0; frame < 4; ++frame) {
        FrameCommand small = command(frame);
        small.views[0] = scaled(small.views[0], 0.5);
        if (frame == 2) {
            gi::test::StopAtAsk const stop(1);
            EXPECT_THROW(asked.render(command(frame), stop, OnStop::give_up), gi::Interrupted);
        }
        SessionFrame const a = asked.render(small, {}), b = never.render(small, {});
        EXPECT_EQ(color(a), color(b)) << frame;
        EXPECT_EQ(a.still_frames, b.still_frames);
        EXPECT_EQ(a.still_frames, int(frame) + 1);
    }
}

TEST(RenderSession, WhatStandsStillConvergesToTheReference)
{
    gi::Report report;
    RenderSession s = started(report), judge = started(report);
    s.apply({"method", "slhb"});
    s.apply({"directions", "icosahedron:320"});
    s.apply({"resolution", 128});
    judge.apply({"method", "reference"});
    judge.apply({"denoise", "none"});
    FrameCommand o = small_command(0);
    o.paths = 800;
    SessionFrame frame, truth = judge.render(o, {});
    double first = 0; // of four paths
    for (o.frame = 0; o.frame < 50; ++o.frame) {
        o.paths = o.frame == 0 ? 4 : 16;
        frame = s.render(o, {});
        if (o.frame == 0) first = relmse(color(frame, 1), color(truth, 1));
    }
    EXPECT_EQ(frame.still_frames, 50);
    EXPECT_LT(relmse(color(frame, 0), color(truth, 0)), 3e-3);
    EXPECT_LT(relmse(color(frame, 1), color(truth, 1)), 3e-3);
    EXPECT_LT(relmse(color(frame, 1), color(truth, 1)), 0.1 * first);
    EXPECT_NEAR(mean(color(frame, 1)) / mean(color(truth, 1)), 1, 0.02);
}

TEST(RenderSession, FirefliesAreClampedForTheFilterAndKeptInTheMean)
{
    // Once a still picture is no longer filtered, it is the mean of all light, as if it had never been.
    gi::Report report, plain_report;
    RenderSession filtered = started(report), plain = started(plain_report);
    plain.apply({"denoise", "none"});
    for (RenderSession* const of : {&filtered, &plain}) of->apply({"bounces", 2});
    SessionFrame a, b;
    for (std::uint64_t f = 0; f < 7; ++f) {
        FrameCommand many = small_command(f);
        many.paths = 147; // 1,029 in all
        a = filtered.render(many, {});
        b = plain.render(many, {});
    }
    for (std::size_t eye = 0; eye < 2; ++eye)
        EXPECT_EQ(a.views[eye].picture.find("color")->data, b.views[eye].picture.find("color")->data);
    std::map<std::string, double> const counts = report.counts();
    ASSERT_TRUE(counts.contains("fireflies clamped"));
    EXPECT_GE(counts.at("fireflies clamped"), counts.at("fireflies clamped, as the other eye does not see them"));
    EXPECT_GT(counts.at("pixels searched for fireflies"), 6 * 2 * 20 * 15 / 2);
    EXPECT_LT(counts.at("light of fireflies spread around them, share"), 0.1);
    EXPECT_FALSE(plain_report.counts().contains("fireflies clamped"));
}

/// Not where its light is shared.
TEST(RenderSession, FirefliesAreLookedForInTheOtherEye)
{
    gi::Report report;
    RenderSession s = started(report);
    s.apply({"method", "paths"});
    s.apply({"share_eyes", false});
    for (std::uint64_t f = 0; f < 6; ++f) s.render(command(f, 0.02 * double(f), true), {});
    EXPECT_GT(report.counts().at("fireflies clamped, as the other eye does not see them"), 0);
}

TEST(RenderSession, ComparesTwoMethods)
{
    gi::Report report;
    RenderSession s = started(report);
    s.apply({"compare", "reference"});
    SessionFrame const f = s.render(command(0), {});
    ASSERT_TRUE(f.views[0].compared.has_value());
    EXPECT_EQ(f.views[0].compared->width, 40);
    s.apply({"compare", ""});
    EXPECT_FALSE(s.render(command(1), {}).views[0].compared.has_value());
}

TEST(RenderSession, RefusesWhatCannotBeAndKeepsAll)
{
    gi::Report report;
    RenderSession s = started(report);
    std::vector<float> const before = color(s.render(command(0), {}));
    Settings const settings = s.settings();
    std::vector<Change> const wrong{{"nonsense", 1},
                                    {"bounces", -1},
                                    {"bounces", 1.5},
                                    {"bounces", "many"},
                                    {"exposure", nullptr},
                                    {"method", "magic"},
                                    {"points", "many"},
                                    {"points", 0},
                                    {"points", "-5%"},
                                    {"ao_radius", -1},
                                    {"light_paths", 0},
                                    {"stereo", "both"},
                                    {"panel", 1},
                                    {"scene", "elsewhere"},
                                    {"scene", 3},
                                    {"light.7.intensity", {1, 1, 1}},
                                    {"light.0.intensity", {1, 1}},
                                    {"light.0.intensity", {1, 1, -1}},
                                    {"light.0.colour", {1, 1, 1}},
                                    {"light.", 1},
                                    {"object.none.position", {0, 0, 0}},
                                    {"object.block.position", {0, 0, 1e30}},
                                    {"object.block.rotation", {0, 0, 0, 0}},
                                    {"material.x.roughness", 0.5},
                                    {"material.0.roughness", 1.5},
                                    {"environment.scale", 2}};
    for (Change const& c : wrong) EXPECT_THROW(s.apply(c), gi::InputError) << c.key << " = " << c.value;
    for (SettingKey const& k : setting_keys()) EXPECT_EQ(get(s.settings(), k.key), get(settings, k.key)) << k.key;
    RenderSession fresh = started(report);
    EXPECT_EQ(color(fresh.render(command(0), {})), before);
    EXPECT_EQ(color(fresh.render(command(1), {})), color(s.render(command(1), {})));
    EXPECT_THROW(RenderSession(scene_of, 0, report).render(command(0), {}), gi::InputError);
}

/// Without a device the setting is refused, and the session continues unchanged.
TEST(RenderSession, RendersByKernelsWhereThereIsADevice)
{
    gi::Report report;
    RenderSession s = started(report), fresh = started(report);
    EXPECT_EQ(color(s.render(command(0), {})), color(fresh.render(command(0), {})));
    s.apply({"device", "cpu"}); // restarts the method
    fresh.apply({"device", "cpu"});
    if (gi::device_present()) {
        s.apply({"device", "cuda"});
        EXPECT_NEAR(mean(color(s.render(command(1), {}))) / mean(color(fresh.render(command(1), {}))), 1, 0.05);
        return;
    }
    try {
        s.apply({"device", "cuda"});
        ADD_FAILURE() << "there is no device";
    } catch (gi::InputError const& e) {
        EXPECT_NE(std::string(e.what()).find("the device cuda cannot be used"), std::string::npos) << e.what();
    }
    EXPECT_EQ(get(s.settings(), "device"), "cpu");
    EXPECT_EQ(color(s.render(command(1), {})), color(fresh.render(command(1), {})));
    EXPECT_THROW(s.apply({"device", "abacus"}), gi::InputError);
}

TEST(RenderSession, EveryKeyCanBeSetToWhatItIs)
{
    Settings s;
    for (SettingKey const& k : setting_keys()) {
        if (!k.is_offered()) continue;
        set(s, {k.key, get(Settings{}, k.key)});
        EXPECT_EQ(get(s, k.key), get(Settings{}, k.key)) << k.key;
        EXPECT_FALSE(k.meaning.empty());
    }
}

/// While a block goes on moving, the viewer takes to following 8 of 40 directions for each bounce, and back: what
/// was reused stays, pictures stay right, and the same orders give the same pixels.
TEST(RenderSession, FewerDirectionsMayFollowWhatMoves)
{
    constexpr std::uint64_t kFrames = 45, kFewer = 15, kAll = 30;
    gi::Report report;
    RenderSession s = started(report), again = started(report), all = started(report), judge = started(report);
    judge.apply({"method", "reference"});
    judge.apply({"reuse", 1});
    judge.apply({"denoise", "none"});
    std::vector<double> error(kFrames), with_all(kFrames);
    for (std::uint64_t f = 0; f < kFrames; ++f) {
        FrameCommand o = command(f, 0.002 * double(f));
        o.paths = 2;
        o.changes.push_back({"object.block.position", {0.004 * double(f), 0, 0}});
        if (f == kFewer) o.changes.push_back({"followed", 8});
        if (f == kAll) o.changes.push_back({"followed", 0});
        FrameCommand const kept = command_from_bytes(to_bytes(o)); // as a recording or another rank has it
        for (Change const& c : o.changes) s.apply(c);
        for (Change const& c : kept.changes) again.apply(c);
        std::vector<float> const now = color(s.render(o, {}));
        ASSERT_EQ(color(again.render(kept, {})), now) << f;
        all.apply(o.changes[0]);
        std::vector<float> const same_axes = color(all.render(o, {}));
        judge.apply(o.changes[0]);
        if (f % 5 != 4 && f != kFewer && f != kAll) continue;
        o.paths = 128;
        std::vector<float> const truth = color(judge.render(o, {}));
        error[f] = relmse(now, truth);
        with_all[f] = relmse(same_axes, truth);
    }
    auto const times = [&](std::uint64_t first, std::uint64_t last) {
        return std::accumulate(error.begin() + long(first), error.begin() + long(last), 0.0) /
               std::accumulate(with_all.begin() + long(first), with_all.begin() + long(last), 0.0);
    };
    EXPECT_EQ(times(0, kFewer), 1);
    EXPECT_LT(times(kFewer, kFewer + 1), 1.3);
    EXPECT_LT(times(kAll, kAll + 1), 1.3);
    EXPECT_LT(times(kFewer + 1, kAll), 1.3);
    EXPECT_LT(times(kAll + 1, kFrames), 1.1);
}

/// A schedule named by the user is used; nothing else then decides how many axes are updated.
TEST(RenderSession, AScheduleThatIsNamedStays)
{
    gi::Report report;
    std::vector<float> pictures[2];
    for (int updated : {0, 8}) {
        RenderSession s = started(report);
        s.apply({"schedule", "stored"});
        s.apply({"updated_axes", updated});
        s.apply({"object.block.position", {0.1, 0, 0}});
        pictures[updated / 8] = color(s.render(command(0), {}));
    }
    EXPECT_EQ(pictures[0], pictures[1]);
}

TEST(RenderSession, PointsAreANumberOrAShareOfTheTexels)
{
    Settings s;
    int const texels = 64 * 64;
    for (auto const& [value, points] : {std::pair{nlohmann::json(2048), 2048},
                                        {nlohmann::json("512"), 512},
                                        {nlohmann::json("25%"), texels / 4},
                                        {nlohmann::json(90.51), 91}}) {
        set(s, {"points", value});
        EXPECT_EQ(s.render.of<gi::VirtualLightSettings>().points_per_map(), points) << value;
        Settings again; // as recordings do
        set(again, {"points", get(s, "points")});
        EXPECT_EQ(again.render.of<gi::VirtualLightSettings>().points_per_map(), points) << value;
    }
}

/// A study changes method, points and radius from stimulus to stimulus.
TEST(RenderSession, ApproximationsOfVisibilityAreShownLiveInStereo)
{
    gi::Report report;
    RenderSession s = started(report);
    s.apply({"light_paths", 64});
    double none = 0;
    for (char const* const method : {"vpl_none", "vpl_exact", "vpl_slhb", "vpl_imperfect", "vpl_ao", "vpl_dao"}) {
        s.apply({"method", method});
        double sum = 0;
        for (std::uint64_t frame = 0; frame < 4; ++frame) {
            SessionFrame const f = s.render(command(frame, 0, true), {});
            sum += mean(color(f)) + mean(color(f, 1));
        }
        if (none == 0) none = sum;
        EXPECT_LE(sum, none * 1.001) << method;
        EXPECT_GT(sum, 0.5 * none) << method;
    }
    s.apply({"ao_radius", 0.0});
    double const before = mean(color(s.render(command(0), {})));
    s.apply({"ao_radius", 0.8});
    EXPECT_LT(mean(color(s.render(command(1), {}))), before) << "dao, wider";
}

TEST(RenderSession, EditsOutliveANewWorld)
{
    gi::Report report;
    RenderSession s = started(report);
    s.apply({"material.2.base_color", {0.9, 0, 0}});
    s.apply({"light.0.intensity", {0, 0, 0}});
    s.apply({"object.block.position", {0.2, 0, 0}}); // from now on it is apart from what stays
    EXPECT_EQ(s.world().materials[kBlock].base_color, (gi::vec3{0.9f, 0, 0}));
    EXPECT_EQ(s.world().lights[0].intensity, gi::vec3{0});
    s.render(command(0), {});
    auto const at = pick(s.world(), gi::look_at({0.4, 0.9, -0.1}, {0.4, 0, -0.1}, 20), 1, {0.5, 0.5});
    ASSERT_TRUE(at.has_value());
    EXPECT_EQ(at->material, kBlock); // where it is now, not where it was
}

TEST(Picking, FindsTheNearestObject)
{
    gi::Report report;
    RenderSession const s = started(report);
    gi::Camera const camera = gi::look_at({0, 0.5, 0.9}, {-0.05, -0.1, -0.1}, 60);
    auto const hit = pick(s.world(), camera, 1.5, {0.5, 0.5});
    ASSERT_TRUE(hit.has_value());
    gi::Scene const& scene = *s.world().scene;
    EXPECT_EQ(scene.nodes[std::size_t(scene.nodes[hit->node].parent)].name, "block");
    EXPECT_EQ(hit->material, kBlock);
    EXPECT_NEAR(glm::length(hit->position - gi::dvec3{0, 0.5, 0.9}), hit->distance_m, 1e-5);
    auto const wall = pick(s.world(), camera, 1.5, {0.02, 0.02});
    ASSERT_TRUE(wall.has_value());
    EXPECT_EQ(wall->material, 0u);
    EXPECT_FALSE(pick(gi::World{}, camera, 1, {0.5, 0.5}).has_value());

    gi::dvec3 const eye{0, 0.5, 0.9}, towards = (hit->position - eye) / hit->distance_m;
    EXPECT_NEAR(free_way_m(s.world(), eye, towards, 10), hit->distance_m, 1e-5);
    EXPECT_EQ(free_way_m(s.world(), eye, towards, 0.5 * hit->distance_m), 0.5 * hit->distance_m);
    EXPECT_EQ(free_way_m(gi::World{}, eye, towards, 3), 3);
}

/// A second eye whose light, past and filter are the first one's has no more error
/// than one that has all of its own.
TEST(RenderSession, ASecondEyeIsAsRightAsTheFirst)
{
    gi::Report report;
    std::array<double, 2> error{};
    std::vector<float> truth;
    for (bool const shared : {false, true}) {
        RenderSession session = started(report), still = started(report);
        session.apply({"share_eyes", shared});
        FrameCommand o;
        SessionFrame last;
        for (std::uint64_t k = 0; k < 12; ++k) {
            o = command(k, 0.005 * double(k), true);
            last = session.render(o, {});
        }
        if (truth.empty()) {
            still.apply({"denoise", "none"});
            still.apply({"share_eyes", false});
            o.paths = 512;
            truth = color(still.render(o, {}), 1);
        }
        error[shared] = relmse(color(last, 1), truth);
    }
    EXPECT_GT(error[0], 1e-5);
    EXPECT_LT(error[0], 0.05);
    EXPECT_GT(report.counts().at("share of pixels lit by a partner view"), 0.5);
    EXPECT_LT(error[1], 1.15 * error[0]);
}

} // namespace
} // namespace viewer::test
