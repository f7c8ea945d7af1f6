// Several clips at once: means by weight, each part of a node for itself.

#include "gi/scene/motion/animation.h"

#include <gtest/gtest.h>

namespace gi::test {
namespace {

Scene one_node()
{
    Scene scene;
    scene.nodes.resize(1);
    scene.nodes[0].translation = {7, 7, 7};
    scene.nodes[0].scale = {3, 3, 3};
    return scene;
}

/// A clip that holds one value, and plays with this weight.
void play(Scene& scene, ChannelPath path, std::vector<float> values, double weight)
{
    AnimationChannel c;
    c.node = 0;
    c.path = path;
    c.times_s = {0};
    c.values = std::move(values);
    Animation clip;
    clip.channels = {c};
    scene.playbacks.push_back({std::int32_t(scene.animations.size()), 0, 1, true, weight});
    scene.animations.push_back(clip);
}

void play_turn(Scene& scene, double degrees, double weight, float sign = 1)
{
    double const half = glm::radians(0.5 * degrees);
    play(scene, ChannelPath::rotation, {0, 0, sign * float(std::sin(half)), sign * float(std::cos(half))}, weight);
}

dmat4 matrix_at(Scene const& scene) { return evaluate_pose(scene, 0.0).world_from_node[0]; }

double turn_deg(Scene const& scene)
{
    dmat4 const m = matrix_at(scene);
    return glm::degrees(std::atan2(m[0].y, m[0].x));
}

TEST(AnimationBlend, TranslationsAreTheirMeanByWeight)
{
    Scene s = one_node();
    play(s, ChannelPath::translation, {10, 0, 0}, 0.2);
    play(s, ChannelPath::translation, {0, 20, 0}, 0.6);
    EXPECT_LT(glm::distance(dvec3(matrix_at(s)[3]), dvec3{2.5, 15, 0}), 1e-9) << "weights sum to 0.8";
    for (Playback& p : s.playbacks) p.weight *= 1e4;
    EXPECT_LT(glm::distance(dvec3(matrix_at(s)[3]), dvec3{2.5, 15, 0}), 1e-9) << "only their ratio counts";
}

TEST(AnimationBlend, RestFillsNothingUp)
{
    Scene s = one_node();
    play(s, ChannelPath::translation, {10, 0, 0}, 0.01);
    EXPECT_LT(glm::distance(dvec3(matrix_at(s)[3]), dvec3{10, 0, 0}), 1e-9);
}

TEST(AnimationBlend, PartsThatAClipDoesNotMoveAreLeftToTheOthers)
{
    Scene s = one_node();
    play(s, ChannelPath::translation, {10, 0, 0}, 1);
    play(s, ChannelPath::scale, {2, 2, 2}, 5);
    dmat4 const m = matrix_at(s);
    EXPECT_LT(glm::distance(dvec3(m[3]), dvec3{10, 0, 0}), 1e-9);
    EXPECT_NEAR(m[0].x, 2, 1e-9);
}

TEST(AnimationBlend, WeightZeroAndBelowDoesNotPlay)
{
    Scene s = one_node();
    play(s, ChannelPath::translation, {10, 0, 0}, 0);
    play(s, ChannelPath::scale, {2, 2, 2}, -1);
    play(s, ChannelPath::rotation, {0, 0, 1, 0}, std::nan(""));
    dmat4 const m = matrix_at(s);
    EXPECT_EQ(dvec3(m[3]), (dvec3{7, 7, 7}));
    EXPECT_EQ(m[0].x, 3);
}

TEST(AnimationBlend, RotationsMeetInOneHemisphere)
{
    for (float const sign : {1.0f, -1.0f}) {
        Scene s = one_node();
        play_turn(s, 10, 1);
        play_turn(s, 70, 1, sign);
        EXPECT_NEAR(turn_deg(s), 40, 1e-4) << "the negated quaternion is the same rotation";
    }
}

TEST(AnimationBlend, RotationsStayWithinADegreeOfSlerp)
{
    for (double weight = 0; weight <= 1; weight += 0.0625) {
        Scene s = one_node();
        play_turn(s, 0, 1 - weight);
        play_turn(s, 90, weight);
        EXPECT_NEAR(turn_deg(s), 90 * weight, 0.92);
    }
}

TEST(AnimationBlend, ThreeRotationsDoNotDependOnTheirOrder)
{
    Scene a = one_node(), b = one_node();
    play_turn(a, 0, 1), play_turn(a, 60, 2), play_turn(a, -30, 0.5);
    play_turn(b, -30, 0.5), play_turn(b, 0, 1), play_turn(b, 60, 2);
    EXPECT_NEAR(turn_deg(a), turn_deg(b), 1e-5);
}

TEST(AnimationBlend, OppositeRotationsAndTinyWeightsHaveNoNaN)
{
    for (double const weight : {1.0, 1e-200, 5e-324}) {
        Scene s = one_node();
        play_turn(s, 0, weight);
        play_turn(s, 360, weight);
        play_turn(s, 180, weight);
        EXPECT_TRUE(std::isfinite(turn_deg(s))) << weight;
    }
}

TEST(AnimationBlend, MorphWeightsAndFramesMix)
{
    Scene s = one_node();
    s.nodes[0].morph_weights = {0.5f, 0.5f, 0.5f};
    play(s, ChannelPath::morph_weights, {1, 0, 0}, 1);
    play(s, ChannelPath::morph_frame, {2.25f}, 3);
    std::vector<float> const w = evaluate_pose(s, 0.0).morph_weights[0];
    EXPECT_NEAR(w[0], 0.25, 1e-6);
    EXPECT_NEAR(w[1], 0.75 * 0.75, 1e-6);
    EXPECT_NEAR(w[2], 0.75 * 0.25, 1e-6);
}

TEST(AnimationBlend, FramesLeadFromTheMeshThroughItsTargetsAndBack)
{
    auto const at = [](double frame) {
        std::vector<double> w(2);
        add_frame(frame, 1, w);
        return w;
    };
    EXPECT_EQ(at(0), (std::vector<double>{0, 0}));
    EXPECT_EQ(at(0.25), (std::vector<double>{0.25, 0}));
    EXPECT_EQ(at(1), (std::vector<double>{1, 0}));
    EXPECT_EQ(at(1.5), (std::vector<double>{0.5, 0.5}));
    EXPECT_EQ(at(2), (std::vector<double>{0, 1}));
    EXPECT_EQ(at(2.75), (std::vector<double>{0, 0.25})) << "the rest is the mesh itself";
    EXPECT_EQ(at(3), at(0));
    std::vector<double> none;
    add_frame(0.5, 1, none);
}

TEST(AnimationBlend, OnlyLoopsPlayTheClosingPart)
{
    Scene s = one_node();
    AnimationChannel c;
    c.node = 0;
    c.times_s = {0, 1, 2};
    c.values = {0, 0, 0, 10, 0, 0, 0, 0, 0};
    Animation clip;
    clip.channels = {c};
    clip.duration_s = 2;
    clip.closing_s = 1;
    s.animations = {clip};
    s.playbacks = {{0, 0, 1, true}};
    EXPECT_NEAR(evaluate_pose(s, 1.5).world_from_node[0][3].x, 5, 1e-6);
    s.playbacks[0].loop = false;
    EXPECT_NEAR(evaluate_pose(s, 1.5).world_from_node[0][3].x, 10, 1e-6);
    EXPECT_NEAR(evaluate_pose(s, 99.0).world_from_node[0][3].x, 10, 1e-6);
}

} // namespace
} // namespace gi::test
