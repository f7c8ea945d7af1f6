// Scenes made ready beside a session, and what recordings say of them.

#include "viewer/engine/scene_start.h"

#include "gi/core/error.h"
#include "gi/methods/registry.h"
#include "gi/scene/generate/generate.h"
#include "viewer/engine/render_session.h"

#include <gtest/gtest.h>
#include <thread>

namespace viewer::test {
namespace {

SceneStart start_at(double z) { return {gi::look_at({0.1, 1.0 / 3, z}, {0, 0.2, 0}, 47.3), 64 * 48 + 1.0 / 7}; }

TEST(SceneStart, SurvivesAsText)
{
    SceneStart s = start_at(1.7);
    s.camera.aperture_radius_m = 0.013;
    s.camera.focus_distance_m = 2.1;
    EXPECT_EQ(start_from_json(nlohmann::json::parse(to_json(s).dump())), s);
    SceneStart flat = start_at(2);
    flat.camera.orthographic = true;
    flat.camera.ymag_m = 0.3;
    EXPECT_EQ(start_from_json(nlohmann::json::parse(to_json(flat).dump())), flat);
    SceneChange const c = scene_change_of(to_change({"a room", s}));
    EXPECT_EQ(c.name, "a room");
    EXPECT_EQ(c.start, s);
    EXPECT_FALSE(scene_change_of({"scene", "a room"}).start);
}

TEST(SceneStart, RefusesWhatIsNone)
{
    nlohmann::json const good = to_json(start_at(1));
    for (auto const& [key, value] : std::vector<std::pair<std::string, nlohmann::json>>{
             {"pixels", 0},
             {"pixels", 1e18},
             {"pixels", "many"},
             {"yfov_rad", nullptr},
             {"world_from_camera", {1, 2, 3}},
             {"world_from_camera", nlohmann::json(std::vector<double>(16, 0.0))}}) {
        nlohmann::json bad = good;
        bad[key] = value;
        EXPECT_THROW(start_from_json(bad), gi::InputError) << bad;
    }
    EXPECT_THROW(start_from_json("somewhere"), gi::InputError);
    EXPECT_THROW(scene_change_of({"scene", 5}), gi::InputError);
    EXPECT_THROW(scene_change_of({"scene", {{"start", good}}}), gi::InputError);
}

std::shared_ptr<gi::Scene const> built_in(std::string const& name, gi::Report&)
{
    if (name == "cornell") return std::make_shared<gi::Scene const>(gi::generate_cornell());
    if (name == "mirror") return std::make_shared<gi::Scene const>(gi::generate_mirror());
    throw gi::InputError("no scene '" + name + "'", "there are two", "use another");
}

FrameCommand frame_at(std::uint64_t frame)
{
    FrameCommand c;
    c.frame = frame;
    c.scene_s = 0.1 * double(frame);
    c.views.push_back({"eye", start_at(1.5 + 0.01 * double(frame)).camera, 40, 30});
    return c;
}

std::vector<float> pixels_of(RenderSession& s, std::uint64_t frame)
{
    return s.render(frame_at(frame), {}).views[0].picture.find("color")->data;
}

/// Pixels of frames before and after another scene. @param ready  true: it is made ready on a thread, and settings
/// change meanwhile as `set` says
std::vector<std::vector<float>> walk_into(bool ready, Change const& set)
{
    gi::Report report;
    RenderSession s(built_in, 0, report);
    s.apply({"method", "slhb"});
    s.apply({"directions", "icosahedron:80"});
    s.apply({"scene", "cornell"});
    std::vector<std::vector<float>> seen{pixels_of(s, 0), pixels_of(s, 1)};
    if (ready) {
        PreparedScene next;
        Settings const before = s.settings();
        std::thread thread(
            [&] { next = s.prepare("mirror", before, [](gi::World const&) { return start_at(2.5); }); });
        seen.push_back(pixels_of(s, 2));
        thread.join();
        s.apply(set);
        EXPECT_NE(next.method, nullptr);
        s.adopt(std::move(next));
    } else {
        seen.push_back(pixels_of(s, 2));
        s.apply(set);
        s.apply(to_change({"mirror", start_at(2.5)}));
    }
    for (std::uint64_t f = 3; f < 6; ++f) seen.push_back(pixels_of(s, f));
    EXPECT_EQ(s.scene_name(), "mirror");
    return seen;
}

TEST(SceneStart, ScenesMadeReadyGiveTheBitsOfAReplay)
{
    for (Change const& set : {Change{"exposure", 1}, Change{"method", "reference"}, Change{"hit_buffer", 32}})
        EXPECT_EQ(walk_into(true, set), walk_into(false, set)) << set.key;
}

TEST(SceneStart, WhatCannotBeReadLeavesTheSession)
{
    gi::Report report;
    RenderSession s(built_in, 0, report);
    s.apply({"scene", "cornell"});
    EXPECT_THROW(s.prepare("nothing", s.settings(), {}), gi::InputError);
    EXPECT_THROW(s.apply(to_change({"nothing", start_at(1)})), gi::InputError);
    EXPECT_EQ(s.scene_name(), "cornell");
    pixels_of(s, 0);
}

/// Mean of the light of a picture.
double mean_light(gi::Picture const& picture)
{
    std::vector<float> const& c = picture.find("color")->data;
    double sum = 0;
    for (float const v : c) sum += double(v);
    return sum / double(c.size());
}

/// The viewer had three bounces and `render` 64: 2.8 % of the light of the Cornell box were missing.
TEST(RenderSession, StillPicturesHaveTheLightOfRender)
{
    gi::Report report;
    RenderSession s(built_in, 0, report);
    s.apply({"scene", "cornell"});
    FrameCommand c;
    c.views.push_back({"eye", s.world().cameras.at(0), 32, 24});
    c.paths = 160;
    double shown = 0;
    for (c.frame = 0; c.frame < 7; ++c.frame) shown = mean_light(s.render(c, {}).views[0].picture);
    gi::RenderSettings settings;
    settings.width = 32;
    settings.height = 24;
    settings.paths = 1024;
    gi::MovingWorld world(std::make_shared<gi::Scene const>(gi::generate_cornell()), 0, report);
    gi::RenderResult const rendered =
        gi::find_method("reference")
            .render(world.world(), c.views[0].camera, settings, gi::StopRequest{}, {}, report);
    EXPECT_NEAR(shown / mean_light(rendered.picture), 1, 0.01);
}

} // namespace
} // namespace viewer::test
