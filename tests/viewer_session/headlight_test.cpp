// The headlight: as bright as it says, with the eye wherever that goes, by every method; off, it leaves no trace; and a
// replay has the same bits.

#include "gi/methods/registry.h"
#include "gi/scene/generate/generate.h"
#include "viewer/engine/render_session.h"

#include <gtest/gtest.h>

namespace viewer::test {
namespace {

/// A matt wall of albedo 0.5, 4 m wide, at z = 0, facing +Z; dark, or with a dim lamp.
std::shared_ptr<gi::Scene const> lit_wall(std::string const& name, gi::Report&)
{
    auto scene = std::make_shared<gi::Scene>();
    scene->name = name;
    gi::Mesh& mesh = scene->meshes.emplace_back();
    mesh.material = 0;
    mesh.positions = {{-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    scene->materials.emplace_back().base_color = gi::vec3(0.5f);
    scene->materials[0].specular = 0;
    scene->material_names = {"wall"};
    gi::Node& node = scene->nodes.emplace_back();
    node.name = "wall";
    node.meshes = {0};
    if (name == "lamp") {
        gi::Node& lamp = scene->nodes.emplace_back();
        lamp.light = 0;
        lamp.translation = {0, 0, 2};
        scene->lights.emplace_back();
    }
    return scene;
}

FrameCommand seen_from(gi::dvec3 eye, std::uint64_t frame = 0)
{
    FrameCommand c;
    c.frame = frame;
    c.views.push_back({"eye", gi::look_at(eye, eye - gi::dvec3(0, 0, 1), 2), 8, 8});
    c.paths = 4;
    return c;
}

std::vector<float> lit_pixels(RenderSession& s, FrameCommand const& c)
{
    return s.render(c, {}).views.at(0).picture.find("color")->data;
}

double mean_radiance(std::vector<float> const& v)
{
    double sum = 0;
    for (float const x : v) sum += double(x);
    return sum / double(v.size());
}

TEST(Headlight, HasTheRadianceThatItSays)
{
    gi::Report report;
    RenderSession s(lit_wall, 0, report);
    for (char const* const key : {"reuse"}) s.apply({key, 1});
    for (Change const& c : {Change{"denoise", "none"}, Change{"method", "reference"}, Change{"scene", "dark"}})
        s.apply(c);
    EXPECT_EQ(mean_radiance(lit_pixels(s, seen_from({0, 0, 3}))), 0);
    s.apply({"headlight", true});
    double const radius = 2 * std::sqrt(2.0);
    EXPECT_NEAR(mean_radiance(lit_pixels(s, seen_from({0, 0, 3}, 1))), 0.5, 0.002);
    EXPECT_NEAR(mean_radiance(lit_pixels(s, seen_from({0, 0, 30}, 2))), 0.5,
                0.002); // as far as the middle of the scene
    EXPECT_NEAR(mean_radiance(lit_pixels(s, seen_from({0, 0, 1}, 3))), 0.5 * radius * radius, 0.05);
    gi::Light const& light = s.world().lights.back();
    EXPECT_EQ(light.type, gi::LightType::point);
    EXPECT_EQ(gi::dvec3(light.position) + s.world().origin, gi::dvec3(0, 0, 1));
}

TEST(Headlight, IsBetweenTheEyes)
{
    FrameCommand c = seen_from({-0.1, 1, 3});
    c.views.push_back({"floor", seen_from({5, 5, 5}).views[0].camera, 8, 8, -1});
    c.views.push_back({"right", seen_from({0.1, 1, 3}).views[0].camera, 8, 8, 0});
    EXPECT_EQ(eye_of(c.views), gi::dvec3(0, 1, 3));
    gi::Report report;
    RenderSession s(lit_wall, 0, report);
    s.apply({"scene", "dark"});
    s.apply({"headlight", true});
    s.headlight_at({1, 1, 1}); // of other views
    lit_pixels(s, seen_from({0, 0, 3}));
    EXPECT_EQ(gi::dvec3(s.world().lights.back().position) + s.world().origin, gi::dvec3(1, 1, 1));
    lit_pixels(s, seen_from({0, 0, 3}, 1));
    EXPECT_EQ(gi::dvec3(s.world().lights.back().position) + s.world().origin, gi::dvec3(0, 0, 3));
}

TEST(Headlight, LightsByEveryMethod)
{
    for (gi::Method const& m : gi::methods()) {
        SCOPED_TRACE(m.name);
        gi::Report report;
        RenderSession s(lit_wall, 0, report);
        s.apply({"method", std::string(m.name)});
        s.apply({"headlight", true});
        s.apply({"scene", "dark"});
        double const light = mean_radiance(lit_pixels(s, seen_from({0, 0, 3})));
        EXPECT_GT(light, 0.4);
        EXPECT_LT(light, 0.6);
    }
}

/// What is off costs nothing and changes nothing: the world has the same lights, and the pictures have the same bits.
TEST(Headlight, SwitchedOffItLeavesNoTrace)
{
    for (char const* const scene : {"dark", "lamp"}) {
        SCOPED_TRACE(scene);
        gi::Report report;
        RenderSession never(lit_wall, 0, report), once(lit_wall, 0, report);
        for (RenderSession* const s : {&never, &once}) s->apply({"scene", scene});
        once.apply({"headlight", true});
        lit_pixels(once, seen_from({0, 0, 3}));
        EXPECT_EQ(once.world().lights.size(), never.world().lights.size() + 1);
        once.apply({"light.all.scale", 0.5}); // of a scene without lights: of the headlight, which it leaves alone
        once.apply({"headlight", false});
        if (once.has_scene() && !once.world().lights.empty()) never.apply({"light.all.scale", 0.5});
        EXPECT_FALSE(once.has_headlight());
        EXPECT_EQ(once.world().lights, never.world().lights);
        EXPECT_EQ(lit_pixels(once, seen_from({0, 0, 3}, 1)), lit_pixels(never, seen_from({0, 0, 3}, 1)));
    }
}

TEST(Headlight, IsNotEditedByItsNumber)
{
    gi::Report report;
    RenderSession s(lit_wall, 0, report);
    s.apply({"scene", "lamp"});
    s.apply({"headlight", true});
    EXPECT_THROW(s.apply({"light.1.scale", 2}), gi::InputError);
    EXPECT_THROW(s.apply({"object.headlight.position", {0, 0, 0}}), gi::InputError);
    s.apply({"light.0.scale", 2});
    s.apply({"object.wall.position", {0, 0, -1}}); // the world is built again
    lit_pixels(s, seen_from({0, 0, 3}));
    EXPECT_EQ(s.world().lights.size(), 2u);
    s.apply({"headlight", false});
    EXPECT_EQ(s.world().lights.size(), 1u);
    EXPECT_EQ(s.world().lights[0].intensity, gi::vec3(2));
}

/// As the live viewer renders them, and as a replay does.
std::vector<std::vector<float>> lit_walk(bool prepares, std::vector<bool> const& on)
{
    gi::Report report;
    RenderSession s(lit_wall, 0, report);
    std::vector<std::vector<float>> seen;
    SceneStart const start{seen_from({0, 0, 3}).views[0].camera, 64};
    s.apply({"headlight", bool(on[0])});
    s.apply(to_change({"lamp", start}));
    for (std::uint64_t f = 0; f < 3; ++f) seen.push_back(lit_pixels(s, seen_from({0, 0.1 * double(f), 3}, f)));
    if (prepares) {
        Settings const as_begun = s.settings();
        PreparedScene made = s.prepare("dark", as_begun, [&](gi::World const&) { return start; });
        s.apply({"headlight", bool(on[1])}); // while it was loading
        s.adopt(std::move(made));
    } else {
        s.apply({"headlight", bool(on[1])});
        s.apply(to_change({"dark", start}));
    }
    for (std::uint64_t f = 3; f < 6; ++f) seen.push_back(lit_pixels(s, seen_from({0, 0.1 * double(f), 3}, f)));
    EXPECT_EQ(s.has_headlight(), bool(on[1]));
    return seen;
}

TEST(Headlight, ReplaysBitForBit)
{
    for (std::vector<bool> const& on : {std::vector<bool>{false, true}, {true, false}, {true, true}})
        EXPECT_EQ(lit_walk(true, on), lit_walk(false, on)) << on[0] << on[1];
}

} // namespace
} // namespace viewer::test
