// Areas hidden by a headset's lenses are set by a change like others: black, not rendered,
// and without effect on visible pixels.

#include "gi/core/error.h"
#include "gi/metrics/metrics.h"
#include "gi/scene/generate/generate.h"
#include "tests/support/scenes.h"
#include "viewer/engine/render_session.h"

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

namespace viewer::test {
namespace {

using gi::test::add_material, gi::test::add_box, gi::test::add_quad, gi::test::lambert, gi::test::emitter;

constexpr int kWidth = 180, kHeight = 160;
constexpr gi::ViewTangents kView{-1.2, 1, -1, 1.1};

/// All outside of a round lens that touches the edges of the view.
HiddenMask around_a_lens()
{
    HiddenMask mask;
    constexpr std::uint32_t kSides = 64;
    for (std::uint32_t k = 0; k < kSides; ++k) {
        double const angle = 2 * gi::kPi * k / kSides;
        glm::dvec2 const way{std::cos(angle), std::sin(angle)};
        glm::dvec2 const middle{0.5 * (kView.left + kView.right), 0.5 * (kView.bottom + kView.top)},
            radius{0.5 * (kView.right - kView.left), 0.5 * (kView.top - kView.bottom)};
        mask.points.push_back(gi::vec2(middle + radius * way));
        mask.points.push_back(gi::vec2(middle + 3.0 * radius * way));
        std::uint32_t const a = 2 * k, b = 2 * ((k + 1) % kSides);
        mask.triangles.insert(mask.triangles.end(), {a, a + 1, b, b, a + 1, b + 1});
    }
    return mask;
}

std::shared_ptr<gi::Scene const> room(std::string const&, gi::Report&)
{
    gi::Scene scene;
    add_box(scene, {-1, -1, -1}, {1, 1, 1}, add_material(scene, lambert(gi::vec3{0.6f})), true);
    add_box(scene, {-0.4f, -1, -0.4f}, {0.3f, 0, 0.2f}, add_material(scene, lambert(gi::vec3{0.2f, 0.6f, 0.2f})),
            false);
    add_quad(scene, {-0.3f, 0.99f, -0.3f}, {0.6f, 0, 0}, {0, 0, 0.6f}, add_material(scene, emitter(gi::vec3{10})));
    return std::make_shared<gi::Scene const>(std::move(scene));
}

FrameCommand view_order(std::uint64_t frame, double aside = 0)
{
    FrameCommand o;
    o.frame = frame;
    gi::Camera camera = gi::look_at({-0.6, 0.1, 0.9}, {0.1, -0.4, 0}, 60);
    camera.off_axis = kView;
    for (int eye = 0; eye < 2; ++eye) {
        camera.world_from_camera =
            camera.world_from_camera * glm::translate(gi::dmat4(1), gi::dvec3{eye == 0 ? aside : 0.06, 0, 0});
        o.views.push_back({eye == 0 ? "left eye" : "right eye", camera, kWidth, kHeight, eye - 1});
    }
    return o;
}

/// Two eyes side by side, one session with masks and one without.
class HiddenViews : public ::testing::Test {
protected:
    HiddenViews()
    {
        for (RenderSession* s : {&masked, &whole}) {
            s->apply({"scene", "room"});
            s->apply({"method", "slhb"});
            s->apply({"resolution", 48});
            s->apply({"directions", "icosahedron:80"});
        }
        for (char const* const name : {"left eye", "right eye"})
            masked.apply(hidden_change(name, around_a_lens()));
    }
    void set(Change const& change)
    {
        masked.apply(change);
        whole.apply(change);
    }

    gi::Report report, other_report;
    RenderSession masked{room, 0, report}, whole{room, 0, other_report};
};

std::vector<float> const& view_color(SessionFrame const& f, std::size_t view = 0)
{
    return f.views[view].picture.find("color")->data;
}

double share(std::vector<std::uint8_t> const& hidden)
{
    return double(std::ranges::count(hidden, 1)) / double(hidden.size());
}

/// Colours of the pixels that have this value in a mask.
std::vector<float> where(std::vector<float> const& view_color, std::vector<std::uint8_t> const& mask, int value)
{
    std::vector<float> out;
    for (std::size_t i = 0; i < mask.size(); ++i)
        if (mask[i] == value) out.insert(out.end(), &view_color[3 * i], &view_color[3 * i] + 3);
    return out;
}

bool is_black(std::vector<float> const& values)
{
    return std::ranges::all_of(values, [](float v) { return v == 0; });
}

/// A mask that hides pixels at full size, and none of a smaller picture of surfaces: no margin, as all else.
TEST_F(HiddenViews, ViewsWithThinMasksHaveNoMargins)
{
    HiddenMask edge; // six pixels wide
    float const right = float(kView.left + 6 * (kView.right - kView.left) / kWidth);
    edge.points = {{-9, -9}, {right, -9}, {right, 9}, {-9, 9}};
    edge.triangles = {0, 1, 2, 0, 2, 3};
    for (char const* const name : {"left eye", "right eye"}) masked.apply(hidden_change(name, edge));
    FrameCommand o = view_order(0);
    o.light_scale = 0.3;
    o.surface_scale = 0.5;
    for (ViewCommand& v : o.views) v.margin_x = v.margin_y = 8;
    SessionFrame const a = masked.render(o, {}), b = whole.render(o, {});
    ASSERT_TRUE(a.views[0].hidden);
    EXPECT_GT(share(*a.views[0].hidden), 0);
    EXPECT_EQ(a.views[0].margin_px, glm::ivec2(0));
    EXPECT_EQ(a.views[0].picture.width, kWidth);
    EXPECT_EQ(b.views[0].margin_px, glm::ivec2(8));
}

/// Without bounces no vertices are shared, so results are equal bit for bit.
TEST_F(HiddenViews, WithoutFilterWhatIsSeenIsTheSameInEveryBit)
{
    for (Change const& c : {Change{"denoise", "none"}, {"reuse", 1}, {"bounces", 0}, {"share_eyes", false}})
        set(c);
    for (char const* const method : {"paths", "reference", "vpl_none"}) {
        set({"method", method});
        SessionFrame const a = masked.render(view_order(0), {}), b = whole.render(view_order(0), {});
        EXPECT_FALSE(b.views[0].hidden);
        for (std::size_t eye = 0; eye < 2; ++eye) {
            ASSERT_TRUE(a.views[eye].hidden);
            auto const& hidden = *a.views[eye].hidden;
            EXPECT_TRUE(is_black(where(view_color(a, eye), hidden, 1))) << method;
            EXPECT_EQ(where(view_color(a, eye), hidden, 0), where(view_color(b, eye), hidden, 0)) << method;
        }
        if (std::string(method) == "paths") {
            std::printf("paths: %.1f %% of the pixels left out, %.1f %% of the look-ups\n",
                        100 * share(*a.views[0].hidden), 100 * (1 - a.rays / b.rays));
            EXPECT_NEAR(1 - a.rays / b.rays, share(*a.views[0].hidden), 0.05);
        }
    }
}

/// While the head moves, with reuse over frames and each filter: nothing of the black beyond the guard band
/// reaches what is seen.
TEST_F(HiddenViews, FiltersDoNotMixBlackIntoWhatIsSeen)
{
    for (Change const& c : {Change{"bounces", 0}, {"share_eyes", false}}) set(c);
    auto const seen = hidden_pixels(around_a_lens(), kView, kWidth, kHeight);
    for (char const* const filter : {"discontinuity", "wide", "atrous"}) {
        set({"denoise", filter});
        SessionFrame a, b;
        for (std::uint64_t f = 0; f < 6; ++f) {
            FrameCommand o = view_order(f, 0.004 * double(f));
            o.paths = 2;
            a = masked.render(o, {});
            b = whole.render(o, {});
        }
        auto const in = where(view_color(a), seen, 0), right = where(view_color(b), seen, 0);
        std::size_t differ = 0;
        float darkest = 0;
        for (std::size_t i = 0; i < in.size(); ++i) {
            differ += in[i] != right[i];
            darkest = std::max(darkest, right[i] - in[i]);
        }
        double const relmse = gi::measure_errors(in, right, 3).relmse;
        std::printf("%s: %.2f %% of what is seen differs, relMSE %.2g, at most %.3f darker\n", filter,
                    100 * double(differ) / double(in.size()), relmse, double(darkest));
        EXPECT_TRUE(is_black(where(view_color(a), *a.views[0].hidden, 1)));
        EXPECT_LT(relmse, 1e-4);
    }
}

TEST_F(HiddenViews, AMaskThatGoesLeavesNoBlackBehind)
{
    for (std::uint64_t f = 0; f < 4; ++f) {
        masked.render(view_order(f), {});
        whole.render(view_order(f), {});
    }
    auto const hidden = masked.render(view_order(4), {}).views[0].hidden;
    ASSERT_TRUE(hidden);
    masked.apply(hidden_change("left eye", {}));
    SessionFrame const a = masked.render(view_order(5), {}), b = whole.render(view_order(5), {});
    EXPECT_FALSE(a.views[0].hidden);
    EXPECT_TRUE(a.views[1].hidden);
    EXPECT_EQ(a.still_frames, 1) << "the mean over frames starts anew";
    auto const in = where(view_color(a), *hidden, 1), right = where(view_color(b), *hidden, 1);
    EXPECT_NEAR(gi::measure_errors(in, right, 3).mean_bias, 1, 0.03);
    EXPECT_EQ(std::ranges::count(in, 0.0f), std::ranges::count(right, 0.0f));
}

/// The orders alone decide, as of a recording or on another rank; of a picture of another size too.
TEST_F(HiddenViews, OrdersBringTheSamePixelsElsewhere)
{
    RenderSession leader(room, 0, report), follower(room, 0, other_report);
    for (RenderSession* s : {&leader, &follower}) s->apply({"scene", "room"});
    for (std::uint64_t f = 0; f < 6; ++f) {
        FrameCommand o = view_order(f, 0.01 * double(f));
        if (f == 1) o.changes.push_back(hidden_change("left eye", around_a_lens()));
        if (f == 2) o.changes.push_back(hidden_change("right eye", around_a_lens()));
        if (f == 4) o.changes.push_back(hidden_change("left eye", {}));
        if (f == 3) o.views[1].width = 90;
        for (Change const& c : o.changes) leader.apply(c);
        SessionFrame const a = leader.render(o, {});
        FrameCommand const there = command_from_bytes(to_bytes(o));
        for (Change const& c : there.changes) follower.apply(c);
        SessionFrame const b = follower.render(there, {});
        for (std::size_t eye = 0; eye < 2; ++eye) EXPECT_EQ(view_color(a, eye), view_color(b, eye)) << f;
        EXPECT_EQ(bool(a.views[0].hidden), f >= 1 && f < 4) << f;
        EXPECT_EQ(bool(a.views[1].hidden), f >= 2) << f;
        if (a.views[1].hidden) {
            EXPECT_EQ(a.views[1].hidden->size(), a.views[1].picture.pixels());
        }
    }
}

TEST_F(HiddenViews, KeepWhatTheyHaveWhereAMaskIsRefused)
{
    SessionFrame const before = masked.render(view_order(0), {});
    EXPECT_THROW(masked.apply({"hidden.left eye", {{"points", {{0, 0}}}, {"triangles", {0, 0, 1}}}}),
                 gi::InputError);
    SessionFrame const after = masked.render(view_order(0), {});
    EXPECT_EQ(after.views[0].hidden, before.views[0].hidden);
    EXPECT_EQ(after.still_frames, 2);
    for (std::size_t k = 0; k + 2 < CommandLimits::views; ++k)
        masked.apply(hidden_change("view " + std::to_string(k), around_a_lens()));
    EXPECT_THROW(masked.apply(hidden_change("one more", around_a_lens())), gi::InputError);
    EXPECT_NO_THROW(masked.apply(hidden_change("left eye", around_a_lens())));
}

} // namespace
} // namespace viewer::test
