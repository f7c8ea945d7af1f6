// Frames whose light is smaller than their views.

#include "gi/core/error.h"
#include "gi/metrics/metrics.h"
#include "gi/scene/generate/generate.h"
#include "tests/support/scenes.h"
#include "viewer/engine/picture_margin.h"
#include "viewer/engine/render_session.h"
#include "viewer/protocol/hidden_mask.h"

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

namespace viewer::test::first_surfaces {
namespace {

using gi::test::add_material, gi::test::add_box, gi::test::add_quad, gi::test::lambert, gi::test::mirror;

/// A room with a mirror, a block at a node of its own and one punctual lamp, or six in "six".
std::shared_ptr<gi::Scene const> scene_of(std::string const& name, gi::Report&)
{
    gi::Scene scene;
    add_box(scene, {-1, -1, -1}, {1, 1, 1}, add_material(scene, lambert(gi::vec3{0.6f})), true);
    add_quad(scene, {-0.9f, -0.6f, -0.98f}, {1.8f, 0, 0}, {0, 1.2f, 0},
             add_material(scene, mirror(gi::vec3{0.9f})));
    for (int k = 0; k < (name == "six" ? 6 : 1); ++k)
        gi::test::add_light(scene, {.position = {0.5f, 0.7f, 0.4f - 0.1f * float(k)}, .intensity = gi::vec3{2}});
    gi::Scene block;
    add_box(block, {-0.4f, -1, -0.4f}, {0.1f, -0.2f, 0.2f}, add_material(block, lambert({0.2f, 0.6f, 0.2f})),
            false);
    append(scene, std::move(block), "block", gi::dmat4(1));
    return std::make_shared<gi::Scene const>(std::move(scene));
}

RenderSession started(gi::Report& report, int threads = 0, char const* scene = "room")
{
    RenderSession s(scene_of, threads, report);
    s.apply({"scene", scene});
    s.apply({"method", "slhb"});
    s.apply({"resolution", 48});
    s.apply({"directions", "icosahedron:80"});
    return s;
}

FrameCommand command(std::uint64_t frame, double light_scale, bool stereo = false, double surface_scale = 1)
{
    FrameCommand o;
    o.frame = frame;
    o.light_scale = light_scale;
    o.surface_scale = surface_scale;
    gi::Camera camera = gi::look_at({-0.6, 0.1, 0.9}, {0.1, -0.3, 0}, 60);
    for (int eye = 0; eye < (stereo ? 2 : 1); ++eye) {
        gi::Camera c = camera;
        c.world_from_camera = camera.world_from_camera *
                              glm::translate(gi::dmat4(1), gi::dvec3{0.004 * double(frame) + 0.06 * eye, 0, 0});
        o.views.push_back({eye == 0 ? "left" : "right", c, 80, 60, eye - 1});
    }
    return o;
}

std::vector<float> const& color(SessionFrame const& f, std::size_t view = 0)
{
    return f.views[view].picture.find("color")->data;
}

double relmse(std::vector<float> const& a, std::vector<float> const& b)
{
    return gi::measure_errors(a, b, 3).relmse;
}

double mean(std::vector<float> const& v)
{
    double sum = 0;
    for (float const x : v) sum += double(x);
    return sum / double(v.size());
}

TEST(FirstSurfaces, ViewsHaveTheirFullSizeAndAreNearThoseOfFullLight)
{
    for (char const* const scene : {"room", "six"}) {
        gi::Report report, other;
        RenderSession small = started(report, 0, scene), full = started(other, 0, scene);
        SessionFrame a, b;
        for (std::uint64_t f = 0; f < 12; ++f) a = small.render(command(f, 0.25, false, f % 3 == 0 ? 0.5 : 1), {});
        FrameCommand o = command(11, 1);
        o.paths = 96;
        b = full.render(o, {});
        EXPECT_EQ(a.views[0].picture.width, 80);
        EXPECT_EQ(a.views[0].picture.height, 60);
        EXPECT_EQ(a.views[0].picture.find("depth")->data.size(), 80u * 60u);
        EXPECT_GT(a.stages_s.at(kSurfacesStage), 0);
        EXPECT_EQ(b.stages_s.count(kSurfacesStage), 0u);
        EXPECT_NEAR(mean(color(a)) / mean(color(b)), 1, 0.06) << scene;
        EXPECT_LT(relmse(color(a), color(b)), 0.05) << scene;
        for (float const v : color(a)) ASSERT_TRUE(std::isfinite(v) && v >= 0);
    }
}

/// A picture with a margin shows the same surfaces within the view, and others beyond it, all of them lit.
TEST(FirstSurfaces, MayBeDrawnBeyondTheView)
{
    gi::Report report;
    RenderSession with = started(report), without = started(report);
    for (std::uint64_t f = 0; f < 4; ++f) {
        FrameCommand o = command(f, 0.25, false, 0.5), wide = o;
        wide.views[0].margin_x = f == 2 ? 8 : 4;
        wide.views[0].margin_y = 4;
        SessionFrame const a = without.render(o, {}), b = with.render(wide, {});
        glm::ivec2 const margin = b.views[0].margin_px;
        ASSERT_EQ(margin, glm::ivec2(wide.views[0].margin_x, 4));
        EXPECT_EQ(a.views[0].margin_px, glm::ivec2(0));
        ASSERT_EQ(b.views[0].picture.width, 80 + 2 * margin.x);
        ASSERT_EQ(b.views[0].picture.height, 60 + 2 * margin.y);
        gi::Picture const inner = without_margin(b.views[0].picture, margin);
        std::vector<float> const &depths = a.views[0].picture.find("depth")->data,
                                 &same = inner.find("depth")->data;
        std::size_t others = 0; // where two samples are equally near, rounding decides
        for (std::size_t i = 0; i < depths.size(); ++i)
            others += std::abs(same[i] - depths[i]) > 1e-4f * depths[i];
        EXPECT_LT(others, depths.size() / 20) << f;
        EXPECT_LT(relmse(inner.find("color")->data, color(a)), 2e-3);
        for (std::size_t i = 0; i < color(b).size(); i += 3) ASSERT_GT(color(b)[i], 0) << i / 3;
    }
}

/// On any number of threads, and from the bytes of a recording. (With the radiance cache, what paths teach each
/// other depends on the number of threads, by the last bit.)
class SameFirstSurfaces : public testing::TestWithParam<char const*> {};

TEST_P(SameFirstSurfaces, OfTheSameCommands)
{
    gi::Report report;
    bool const cached = std::string(GetParam()) == "auto";
    RenderSession two = started(report, 2), one = started(report, cached ? 2 : 1);
    for (RenderSession* const s : {&two, &one}) s->apply({"radiance_cache", GetParam()});
    for (std::uint64_t f = 0; f < 8; ++f) {
        // Light and surfaces change their sizes on the way.
        FrameCommand o = command(f, f % 4 == 3 ? 1 : 0.25, true, f % 4 == 1 ? 0.5 : 1);
        if (f >= 2) o.changes.push_back({"object.block.position", {0.03 * double(f), 0, 0}});
        if (f == 5) o.changes.push_back({"light.0.intensity", {3, 2, 1}});
        FrameCommand const kept = command_from_bytes(to_bytes(o));
        for (Change const& c : o.changes) two.apply(c);
        for (Change const& c : kept.changes) one.apply(c);
        SessionFrame const a = two.render(o, {}), b = one.render(kept, {});
        for (std::size_t view : {std::size_t(0), std::size_t(1)}) ASSERT_EQ(color(a, view), color(b, view)) << f;
    }
}

INSTANTIATE_TEST_SUITE_P(RadianceCache, SameFirstSurfaces, testing::Values("off", "auto"));

/// Then light has the size of the views.
TEST(FirstSurfaces, OrthographicCamerasAndLensesDoWithout)
{
    for (bool const lens : {false, true}) {
        gi::Report report;
        RenderSession s = started(report), full = started(report);
        FrameCommand o = command(0, 0.25), same = command(0, 1);
        for (FrameCommand* const c : {&o, &same}) {
            gi::Camera& camera = c->views[0].camera;
            if (lens) {
                camera.aperture_radius_m = 0.01;
                camera.focus_distance_m = 1;
            } else {
                camera.orthographic = true;
                camera.ymag_m = 0.5;
            }
        }
        EXPECT_FALSE(has_own_surfaces(o));
        SessionFrame const f = s.render(o, {});
        EXPECT_EQ(f.views[0].picture.width, 80);
        EXPECT_EQ(f.stages_s.count(kSurfacesStage), 0u);
        EXPECT_EQ(color(f), color(full.render(same, {})));
    }
}

TEST(FirstSurfaces, ComparedMethodsAndHiddenPixelsAreDrawnToo)
{
    gi::Report report;
    RenderSession s = started(report);
    s.apply({"compare", "reference"}); // cannot leave out the light of punctual lights
    s.apply(hidden_change("left", {{{-9, 0.1f}, {9, 0.1f}, {9, 9}, {-9, 9}}, {0, 1, 2, 0, 2, 3}})); // upper part
    SessionFrame f;
    for (std::uint64_t k = 0; k < 6; ++k) {
        FrameCommand o = command(k, 0.25, false, k % 2 == 0 ? 1 : 0.5);
        o.paths = 16;
        f = s.render(o, {});
    }
    ASSERT_TRUE(f.views[0].compared.has_value());
    EXPECT_EQ(f.views[0].compared->width, 80);
    EXPECT_EQ(f.views[0].picture.width, 80);
    std::vector<float> const &main = color(f), &other = f.views[0].compared->find("color")->data;
    EXPECT_NEAR(mean(main) / mean(other), 1, 0.08);
    ASSERT_TRUE(f.views[0].hidden != nullptr);
    std::vector<std::uint8_t> const& hidden = *f.views[0].hidden;
    ASSERT_EQ(hidden.size(), 80u * 60u);
    EXPECT_GT(std::ranges::count(hidden, 1), 80 * 15);
    for (std::size_t i = 0; i < 3 * hidden.size(); ++i) {
        if (hidden[i / 3] == 0) continue;
        ASSERT_EQ(main[i], 0) << i;
        ASSERT_EQ(other[i], 0) << i;
    }
}

/// What was averaged before is still there when surfaces get another size: the picture changes no more than if the
/// size had stayed, at outlines too.
TEST(FirstSurfaces, AChangeOfSizeKeepsWhatWasAveraged)
{
    auto const change_to = [](double after) {
        gi::Report report;
        RenderSession s = started(report);
        SessionFrame mean;
        for (std::uint64_t f = 0; f < 24; ++f) mean = s.render(command(0, 0.25, false, 0.5), {});
        return relmse(color(s.render(command(0, 0.25, false, after), {})), color(mean));
    };
    double const same = change_to(0.5);
    for (double const after : {0.75, 1.0}) EXPECT_LT(change_to(after), 1.2 * same) << after; // lost: 1.6 times
}

/// Without reuse nothing of earlier frames is kept, and successive pictures of a still view are equal.
TEST(FirstSurfaces, AStillPictureIsStillWithSmallLightAndWithoutReuse)
{
    gi::Report report;
    RenderSession s = started(report);
    s.apply({"reuse", 1});
    for (std::uint64_t f = 0; f < 3; ++f) {
        SessionFrame const frame = s.render(command(0, 0.5), {});
        if (f > 0) {
            EXPECT_EQ(frame.still_frames, int(f) + 1);
        }
    }
}

/// From moving to still: light begins with what was known, so the first full frame is not noisy.
TEST(FirstSurfaces, FullLightBeginsWithWhatWasKnown)
{
    gi::Report report;
    RenderSession s = started(report), fresh = started(report), judge = started(report);
    for (std::uint64_t f = 0; f < 10; ++f) s.render(command(f, 0.5), {});
    FrameCommand many = command(10, 1);
    many.paths = 256;
    SessionFrame const truth = judge.render(many, {});
    double const with = relmse(color(s.render(command(10, 1), {})), color(truth)),
                 without = relmse(color(fresh.render(command(10, 1), {})), color(truth));
    EXPECT_LT(with, 0.8 * without);
}

/// What windows need to draw surfaces for newer cameras; without the setting, frames are as they were.
TEST(FirstSurfaces, BringWhatOthersNeedToDrawThem)
{
    gi::Report report;
    RenderSession plain = started(report), s = started(report);
    s.apply({"draw_surfaces", true});
    SessionFrame const before = plain.render(command(0, 0.5, false, 0.5), {});
    EXPECT_EQ(before.scene, nullptr);
    EXPECT_EQ(before.views[0].light, nullptr);
    SessionFrame const first = s.render(command(0, 0.5, false, 0.5), {}),
                       moved = s.render(command(9, 0.5, false, 0.5), {});
    EXPECT_EQ(first.scene->world, moved.scene->world);
    EXPECT_EQ(first.scene->moved, moved.scene->moved); // nothing has moved
    for (SessionFrame const* f : {&first, &moved}) {
        gi::LightPicture const& light = *f->views[0].light;
        EXPECT_EQ(light.width, 40);
        EXPECT_GT(std::ranges::count_if(light.texels, [](gi::LightTexel const& t) { return t.depth_dark > 7; }),
                  40 * 30 / 2);
        EXPECT_EQ(light.slopes.size(), light.texels.size());
        for (int c = 0; c < 3; ++c) EXPECT_GT(light.mean[c], 0);
    }
    EXPECT_EQ(color(first), color(before)); // pictures are the same
    plain.render(command(9, 0.5, false, 0.5), {});
    EXPECT_EQ(color(s.render(command(9, 1), {})), color(plain.render(command(9, 1), {})));
    SessionFrame const whole = s.render(command(9, 1), {});
    EXPECT_EQ(whole.views[0].light->width, 80); // of its layers
    EXPECT_TRUE(whole.views[0].light->slopes.empty());
    s.apply({"object.block.position", nlohmann::json::array({0.1, 0, 0})});
    EXPECT_NE(s.render(command(9, 1), {}).scene->world, moved.scene->world);
}

/// Where others draw the surfaces, what they are lit by is the same, and so is every other picture.
TEST(FirstSurfaces, OfLightAloneLeaveTheRestAsItIs)
{
    gi::Report report;
    RenderSession quick = started(report), whole = started(report);
    whole.draw_all_surfaces();
    for (RenderSession* const s : {&quick, &whole}) s->apply({"draw_surfaces", true});
    std::uint64_t f = 0;
    for (bool const only_light : {false, true, true, false, false}) {
        FrameCommand c = command(f++, 0.5, false, 0.5);
        c.only_light = only_light;
        SessionFrame const a = quick.render(c, {}), b = whole.render(c, {});
        EXPECT_EQ(a.views[0].picture.width, only_light ? 40 : 80);
        EXPECT_EQ(b.views[0].picture.width, 80);
        auto const same = [](gi::LightTexel const& p, gi::LightTexel const& q) {
            return p.normal == q.normal && p.plane_m == q.plane_m && p.light == q.light &&
                   p.depth_dark == q.depth_dark;
        };
        EXPECT_TRUE(std::ranges::equal(a.views[0].light->texels, b.views[0].light->texels, same));
        if (!only_light) {
            EXPECT_EQ(color(a), color(b));
        }
    }
    EXPECT_EQ(color(quick.render(command(f, 1), {})), color(whole.render(command(f, 1), {})));
}

} // namespace
} // namespace viewer::test::first_surfaces
