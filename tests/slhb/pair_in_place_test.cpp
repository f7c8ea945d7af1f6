// Where things only vanish, the picture without them is that of all its paths in its own world, in every bit and
// layer, though only those are traced that what moves may count in.

#include "gi/hit_buffers/settings.h"
#include "gi/scene/generate/generate.h"
#include "tests/slhb/slhb_render.h"

#include <algorithm>
#include <cstring>
#include <glm/gtc/matrix_transform.hpp>

namespace gi::test {
namespace {

struct Place {
    std::string name;
    std::function<void(Scene&)> real, object;
    double time_step_s = 0; ///< between frames
};
std::ostream& operator<<(std::ostream& out, Place const& p) { return out << p.name; }

void pair_room(Scene& s)
{
    s = box_with_block_and_lamp();
    Material gloss = lambert(vec3{0.5f});
    gloss.specular = 1;
    gloss.roughness = 0.1f;
    add_sphere(s, {-0.6f, -0.7f, 0.5f}, 0.3f, 2, add_material(s, mirror(vec3{0.9f})), true);
    add_sphere(s, {0.7f, -0.75f, -0.3f}, 0.25f, 2, add_material(s, glass(1.5f, false)), true);
    add_quad(s, {-0.99f, -0.5f, -0.5f}, {0, 0, 1}, {0, 1, 0}, add_material(s, gloss));
}

void table_under_the_sky(Scene& s)
{
    add_box(s, {-1, -1.1f, -1}, {1, -1, 1}, add_material(s, lambert(vec3{0.6f})), false);
    EnvironmentMap sky;
    sky.width = 8;
    sky.height = 4;
    for (int k = 0; k < 32; ++k) sky.radiance.push_back(vec3{k == 5 ? 40.0f : 0.2f + 0.03f * float(k)});
    s.environment = sky;
}

void two_lamps(Scene& s)
{
    add_box(s, {-1, -1, -1}, {1, 1, 1}, add_material(s, lambert(vec3{0.6f})), true);
    add_light(s, {.position = {0.5f, 0.8f, 0.4f}});
    add_light(s, {.type = LightType::directional, .direction = glm::normalize(vec3{0.3f, -1, 0.2f})});
}

void block(Scene& s)
{
    add_box(s, {0.2f, -1, 0.2f}, {0.5f, -0.5f, 0.5f}, add_material(s, lambert(vec3{0.7f, 0.2f, 0.1f})), false);
}

void mirror_and_glass(Scene& s)
{
    add_sphere(s, {0.3f, -0.7f, 0.3f}, 0.25f, 2, add_material(s, mirror(vec3{0.8f})), true);
    add_sphere(s, {-0.2f, -0.8f, 0.6f}, 0.15f, 2, add_material(s, glass(1.4f, false)), true);
}

void fence(Scene& s)
{
    Material m = lambert(vec3{0.8f});
    m.alpha_mode = AlphaMode::mask;
    add_quad(s, {0, -1, 0.4f}, {0.6f, 0, 0}, {0, 0.6f, 0}, add_material(s, m));
    block(s);
}

void walker(Scene& s)
{
    append(s, generate_avatar(), "walker",
           glm::translate(dmat4(1), dvec3{0.2, -1, 0.2}) * glm::scale(dmat4(1), dvec3(0.5)));
}

class InPlace : public testing::TestWithParam<Place> {
protected:
    InPlace()
    {
        Scene joint, object;
        GetParam().real(joint);
        GetParam().object(object);
        node_ = joint.nodes.size();
        append(joint, object, "object", dmat4(1));
        joint.nodes[node_].driven = true;
        scene_ = std::make_shared<Scene const>(std::move(joint));
        settings_ = small_settings(40, 1, 3);
        settings_.of<SlhbSettings>().resolution = 32;
        settings_.of<SlhbSettings>().light_samples = 4;
        settings_.of<SlhbSettings>().fresh_light_samples = 2;
        settings_.of<SlhbSettings>().shadow_resolution = 32;
    }
    Pose pose(double time_s, PairSide side) const
    {
        Pose p = evaluate_pose(*scene_, time_s);
        dvec3 const at{0.3, -0.8, 0.3}; // in the room that there is for what moves
        if (side == PairSide::without)
            for (std::size_t n = node_; n < scene_->nodes.size(); ++n)
                p.world_from_node[n] = glm::scale(glm::translate(dmat4(1), at), dvec3(1e-12));
        return p;
    }
    using Start = std::unique_ptr<FrameRenderer> (*)(MovingWorld const&, Camera const&, RenderSettings const&,
                                                     Report&);
    std::vector<PairResult> frames(PairDifference difference, Report& report,
                                   Start start = start_frames_as_set, std::uint32_t times = 1) const
    {
        MovingWorld world(scene_, 0, report);
        Camera const eye = look_at({-0.6, 0.1, 0.95}, {0.2, -0.6, 0}, 80);
        auto const frames = start(world, eye, settings_, report);
        std::vector<PairResult> results;
        for (int k = 0; k < 3; ++k)
            results.push_back(ask<PairFrames>(*frames)->pair(
                {eye, 40, 40}, {(k == 1 ? 1u : 3u) * times, difference},
                [&](PairSide side) { return world.advance(pose(k * GetParam().time_step_s, side)); }, {}));
        return results;
    }

    std::size_t node_;
    std::shared_ptr<Scene const> scene_;
    RenderSettings settings_;
};

INSTANTIATE_TEST_SUITE_P(Places, InPlace,
                         testing::Values(Place{"block", pair_room, block},
                                         Place{"mirror_and_glass", pair_room, mirror_and_glass},
                                         Place{"sky", table_under_the_sky, block},
                                         Place{"lamps", two_lamps, block}, Place{"fence", pair_room, fence},
                                         Place{"walker", table_under_the_sky, walker, 0.2},
                                         Place{"walker_in_a_room", pair_room, walker, 0.2}),
                         [](auto const& p) { return p.param.name; });

void expect_same(Picture const& a, Picture const& b, std::string const& what)
{
    ASSERT_EQ(a.layers.size(), b.layers.size());
    for (std::size_t k = 0; k < a.layers.size(); ++k) {
        ASSERT_EQ(a.layers[k].name, b.layers[k].name);
        std::size_t differ = 0;
        for (std::size_t i = 0; i < a.layers[k].data.size(); ++i)
            differ += std::memcmp(&a.layers[k].data[i], &b.layers[k].data[i], sizeof(float)) != 0 ? 1 : 0;
        EXPECT_EQ(differ, 0u) << what << ", " << a.layers[k].name;
    }
}

TEST_P(InPlace, GivesTheBitsOfBothWorlds)
{
    for (Schedule const schedule : {Schedule::stored, Schedule::temporal}) {
        settings_.of<SlhbSettings>().schedule = schedule;
        if (schedule == Schedule::temporal) settings_.of<SlhbSettings>().axes = 8, settings_.of<SlhbSettings>().fresh_axes = 2;
        Report report, whole_report;
        auto const quick = frames(PairDifference::vanishing, report),
                   whole = frames(PairDifference::anything, whole_report);
        for (std::size_t k = 0; k < whole.size(); ++k) {
            std::string const what = "frame " + std::to_string(k);
            expect_same(quick[k].with.picture, whole[k].with.picture, what + " with");
            expect_same(quick[k].without.picture, whole[k].without.picture, what + " without");
            EXPECT_EQ(quick[k].coverage, whole[k].coverage) << what;
            EXPECT_EQ(quick[k].covered, whole[k].covered) << what;
            EXPECT_EQ(quick[k].without.paths, whole[k].without.paths);
        }
        double const share = report.counts().at("share of a pair's paths traced on both sides");
        EXPECT_GT(share, 0.01);
        EXPECT_LT(share, 0.9);
        EXPECT_EQ(whole_report.counts().count("share of a pair's paths traced on both sides"), 0u);
    }
}

/// Indirect light by layers of the view; whole passes have other light samples, so it is the same within the noise.
TEST_P(InPlace, GivesTheLightOfBothWorldsOnTheScreen)
{
    settings_.of<SlhbSettings>().light_samples = settings_.of<SlhbSettings>().fresh_light_samples = 64;
    settings_.of<SlhbSettings>().shadow_resolution = 128;
    Report report;
    constexpr std::uint32_t kTimes = 8; // against noise
    auto const quick = frames(PairDifference::vanishing, report, start_screen_lhb_frames, kTimes),
               whole = frames(PairDifference::anything, report, start_screen_lhb_frames, kTimes);
    auto const light = [](std::vector<PairResult> const& all, auto side) {
        double sum = 0;
        for (PairResult const& r : all) sum += mean_of((r.*side).picture, "L2").mean;
        return sum;
    };
    double const with = light(whole, &PairResult::with), without = light(whole, &PairResult::without);
    EXPECT_NEAR(light(quick, &PairResult::with), with, 0.2 * with);
    // Of the ground under a sky alone there is hardly any (found: up to 1.6 % of that with the object, which must have left
    // the layers, too).
    EXPECT_NEAR(light(quick, &PairResult::without), without, std::max(0.04 * without, 0.03 * with));
}

} // namespace
} // namespace gi::test
