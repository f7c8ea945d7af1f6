// Keys by hand, time wrapping, poses through a chain of nodes.

#include "gi/scene/motion/animation.h"

#include <gtest/gtest.h>

namespace gi::test {
namespace {

float value_at(AnimationChannel const& channel, double time_s)
{
    float v[3];
    sample_channel(channel, time_s, 3, v);
    return v[0];
}

AnimationChannel slide(Interpolation interpolation, std::vector<float> x)
{
    AnimationChannel c;
    c.node = 0;
    c.interpolation = interpolation;
    c.times_s = {1, 3};
    for (float const v : x) c.values.insert(c.values.end(), {v, 0, 0});
    return c;
}

TEST(Animation, LinearIsHeldOutsideItsKeys)
{
    AnimationChannel const c = slide(Interpolation::linear, {10, 20});
    EXPECT_FLOAT_EQ(value_at(c, 0), 10);
    EXPECT_FLOAT_EQ(value_at(c, 1), 10);
    EXPECT_FLOAT_EQ(value_at(c, 1.5), 12.5f);
    EXPECT_FLOAT_EQ(value_at(c, 3), 20);
    EXPECT_FLOAT_EQ(value_at(c, 99), 20);
}

TEST(Animation, StepKeepsTheEarlierKeyUntilTheNext)
{
    AnimationChannel const c = slide(Interpolation::step, {10, 20});
    EXPECT_FLOAT_EQ(value_at(c, 2.999), 10);
    EXPECT_FLOAT_EQ(value_at(c, 3), 20);
}

/// glTF 2, appendix C.5 with td = 2, t = 1/4: h00 = 27/32, h10 = 9/64, h01 = 5/32, h11 = -3/64.
TEST(Animation, CubicSplineByHand)
{
    AnimationChannel const c = slide(Interpolation::cubic_spline, {7, 10, 4, -8, 20, 5}); // in, value, out per key
    double const expected = 27.0 / 32 * 10 + 2 * 9.0 / 64 * 4 + 5.0 / 32 * 20 + 2 * (-3.0 / 64) * -8;
    EXPECT_NEAR(double(value_at(c, 1.5)), expected, 1e-6);
    EXPECT_FLOAT_EQ(value_at(c, 0), 10);
    EXPECT_FLOAT_EQ(value_at(c, 3), 20);
    EXPECT_FLOAT_EQ(value_at(c, 4), 20);
}

TEST(Animation, RotationsTakeTheShortWay)
{
    AnimationChannel c;
    c.path = ChannelPath::rotation;
    c.times_s = {0, 1};
    float const half = std::sqrt(0.5f);
    c.values = {0, 0, 0, 1, 0, -half, 0, -half}; // 90 degrees about +Y, as the negated quaternion
    float q[4];
    sample_channel(c, 0.5, 4, q);
    float const sign = q[3] < 0 ? -1.0f : 1.0f;
    EXPECT_NEAR(sign * q[1], std::sin(kPi / 8), 1e-6f);
    EXPECT_NEAR(sign * q[3], std::cos(kPi / 8), 1e-6f);
}

TEST(Animation, CubicRotationsComeOutUnit)
{
    AnimationChannel c;
    c.path = ChannelPath::rotation;
    c.interpolation = Interpolation::cubic_spline;
    c.times_s = {0, 1};
    c.values = {0, 0, 0, 0, 0, 0, 0, 1, 3, 0, 0, 0, 0, 3, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0};
    float q[4];
    for (double t = 0; t <= 1; t += 0.125) {
        sample_channel(c, t, 4, q);
        EXPECT_NEAR(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3], 1, 1e-6f) << t;
    }
}

TEST(Animation, LocalTime)
{
    EXPECT_DOUBLE_EQ(local_time({0, 0.5, 2, true}, 3, 4), 2.5);
    EXPECT_DOUBLE_EQ(local_time({0, 0, -1, true}, 3, 1), 2);
    EXPECT_DOUBLE_EQ(local_time({0, 0, 1, false}, 3, 4), 3);
    EXPECT_DOUBLE_EQ(local_time({0, -5, 1, false}, 3, 4), 0);
    EXPECT_DOUBLE_EQ(local_time({0, 1, 1, true}, 0, 4), 0);
    for (double const t : {-1e-18, 0.3, 2.9999999999999999, 1e15}) {
        double const local = local_time({0, 0, 1, true}, 3, t);
        EXPECT_GE(local, 0) << t;
        EXPECT_LE(local, 3) << t;
    }
}

TEST(Animation, ChildrenFollowParentsAndRestWithoutTime)
{
    Scene scene;
    scene.nodes.resize(2);
    scene.nodes[0].rotation = glm::angleAxis(glm::half_pi<double>(), dvec3{0, 1, 0});
    scene.nodes[1].parent = 0;
    scene.nodes[1].translation = {1, 0, 0};
    Animation clip;
    clip.duration_s = 3;
    clip.channels = {slide(Interpolation::linear, {10, 20})};
    scene.animations = {clip};
    scene.playbacks = {{0, 0, 1, true}};

    dvec3 const rest(evaluate_pose(scene, std::nullopt).world_from_node[1][3]);
    EXPECT_LT(glm::distance(rest, dvec3{0, 0, -1}), 1e-12);
    dvec3 const moved(evaluate_pose(scene, 2.0).world_from_node[1][3]);
    EXPECT_LT(glm::distance(moved, dvec3{15, 0, -1}), 1e-6);
}

TEST(Animation, MorphWeightsAreAnimated)
{
    Scene scene;
    scene.nodes.resize(1);
    scene.nodes[0].morph_weights = {0.25f, 0.75f};
    AnimationChannel c;
    c.node = 0;
    c.path = ChannelPath::morph_weights;
    c.times_s = {0, 2};
    c.values = {0, 1, 1, 0};
    Animation clip;
    clip.duration_s = 2;
    clip.channels = {c};
    scene.animations = {clip};
    scene.playbacks = {{0, 0, 1, true}};
    EXPECT_EQ(evaluate_pose(scene, std::nullopt).morph_weights[0], (std::vector<float>{0.25f, 0.75f}));
    EXPECT_EQ(evaluate_pose(scene, 0.5).morph_weights[0], (std::vector<float>{0.25f, 0.75f}));
    EXPECT_EQ(evaluate_pose(scene, 1.0).morph_weights[0], (std::vector<float>{0.5f, 0.5f}));
}

} // namespace
} // namespace gi::test
