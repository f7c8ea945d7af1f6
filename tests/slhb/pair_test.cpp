// A view with and without what moves: each picture is that of its world, and paths that see
// no difference are equal in every bit.

#include "gi/core/error.h"
#include "gi/hit_buffers/settings.h"
#include "gi/methods/registry.h"
#include "tests/slhb/slhb_render.h"

#include <glm/gtc/matrix_transform.hpp>

namespace gi::test {
namespace {

/// A room, and a block in it that can vanish.
class Pairs : public testing::TestWithParam<Schedule> {
protected:
    Pairs()
    {
        Scene room = box_with_block_and_lamp(), block;
        add_box(block, {0.4f, -1, 0.3f}, {0.7f, -0.6f, 0.6f}, add_material(block, lambert(vec3{0.7f, 0.2f, 0.1f})),
                false);
        node_ = room.nodes.size();
        append(room, block, "object", dmat4(1));
        room.nodes[node_].driven = true;
        scene_ = std::make_shared<Scene const>(std::move(room));
        settings_ = small_settings(48, 1, 3);
        settings_.of<SlhbSettings>().schedule = GetParam();
        settings_.of<SlhbSettings>().resolution = 48;
    }
    Pose pose(PairSide side) const
    {
        Pose p = evaluate_pose(*scene_, std::nullopt);
        if (side == PairSide::without)
            for (std::size_t n = node_; n < scene_->nodes.size(); ++n) p.world_from_node[n] *= dmat4(0);
        return p;
    }
    static Camera camera() { return look_at({-0.6, 0.1, 0.9}, {0.3, -0.6, 0}, 70); }
    FrameView view() const { return {camera(), 48, 48}; }

    PairResult rendered(std::uint32_t paths, PairSide first = PairSide::with, PairSide second = PairSide::without)
    {
        MovingWorld world(scene_, 0, report_);
        auto const frames = start_frames_as_set(world, camera(), settings_, report_);
        return ask<PairFrames>(*frames)->pair(
            view(), {paths},
            [&](PairSide side) { return world.advance(pose(side == PairSide::with ? first : second)); }, stop_);
    }
    std::vector<float> alone(PairSide side, std::uint32_t paths)
    {
        MovingWorld world(scene_, 0, report_);
        auto const frames = start_frames_as_set(world, camera(), settings_, report_);
        frames->changed(world.advance(pose(side)));
        FrameView const v = view();
        return frames->views({&v, 1}, paths, VertexSharing::none, stop_)[0].picture.find("color")->data;
    }
    static std::vector<float> const& color(RenderResult const& r) { return r.picture.find("color")->data; }

    std::size_t node_;
    std::shared_ptr<Scene const> scene_;
    RenderSettings settings_;
    Report report_;
    StopRequest stop_;
};

INSTANTIATE_TEST_SUITE_P(Schedules, Pairs,
                         testing::Values(Schedule::stored, Schedule::streamed, Schedule::temporal),
                         [](auto const& p) {
                             return p.param == Schedule::stored     ? "stored"
                                    : p.param == Schedule::streamed ? "streamed"
                                                                    : "temporal";
                         });

TEST_P(Pairs, AreThePicturesOfTheirWorlds)
{
    for (std::uint32_t paths : {1u, 3u}) {
        PairResult const both = rendered(paths);
        EXPECT_EQ(color(both.with), alone(PairSide::with, paths)) << paths;
        EXPECT_EQ(color(both.without), alone(PairSide::without, paths)) << paths;
    }
}

TEST_P(Pairs, WithNothingThereAreEqualInEveryBit)
{
    PairResult const both = rendered(3, PairSide::without, PairSide::without);
    EXPECT_EQ(color(both.with), color(both.without));
    EXPECT_EQ(*std::max_element(both.coverage.begin(), both.coverage.end()), 0);
}

TEST_P(Pairs, DifferOnlyWhereTheObjectCounts)
{
    settings_.bounces = 0;
    PairResult const both = rendered(1);
    std::size_t equal = 0, covered = 0;
    for (std::size_t p = 0; p < both.coverage.size(); ++p) {
        bool const same =
            std::equal(&color(both.with)[3 * p], &color(both.with)[3 * p] + 3, &color(both.without)[3 * p]);
        equal += same ? 1 : 0;
        covered += both.coverage[p] > 0 ? 1 : 0;
        float const before = both.without.picture.find("depth")->data[p],
                    now = both.with.picture.find("depth")->data[p];
        EXPECT_EQ(both.coverage[p] == 1, now < before) << p;
        for (int c = 0; c < 3; ++c)
            EXPECT_EQ(both.covered[p][c], both.coverage[p] * color(both.with)[3 * p + std::size_t(c)]) << p;
    }
    EXPECT_GT(covered, 50u);
    EXPECT_GT(equal, both.coverage.size() / 2);
    EXPECT_LT(equal, both.coverage.size() - covered) << "it casts a shadow";
}

TEST_P(Pairs, ThatAreStoppedHaveAsManyPathsOnBothSides)
{
    stop_.request();
    PairResult const both = rendered(4);
    EXPECT_EQ(both.with.paths, 1u);
    EXPECT_EQ(both.without.paths, 1u);
    EXPECT_EQ(both.with.end, RenderEnd::interrupted);
}

TEST(PairsByMethod, AreWhatTheTraitSays)
{
    Report report;
    MovingWorld world(std::make_shared<Scene const>(box_with_block_and_lamp()), 0, report);
    Camera const eye = look_at({-0.6, 0.1, 0.9}, {0, 0, 0}, 60);
    for (Method const& m : methods()) {
        auto const frames = m.frames(world, eye, small_settings(8, 1, 1), report);
        EXPECT_EQ(ask<PairFrames>(*frames) != nullptr, m.pairs) << m.name;
    }
}

} // namespace
} // namespace gi::test
