// Poses and rotations: log and exp, inverse, composition, interpolation, headings.

#include "gi/core/pose.h"

#include <gtest/gtest.h>
#include <random>

namespace gi::test {
namespace {

class RandomPoses {
public:
    RigidPose operator()() { return {vector(), glm::normalize(dquat(n(), n(), n(), n()))}; }
    dvec3 vector() { return {n(), n(), n()}; }

private:
    double n() { return normal_(bits_); }
    std::mt19937 bits_{1};
    std::normal_distribution<double> normal_;
};

double distance(RigidPose const& a, RigidPose const& b)
{
    return glm::distance(a.position, b.position) + 1 - std::abs(glm::dot(a.rotation, b.rotation));
}

TEST(Rotation, LogAndExpAreInverse)
{
    RandomPoses random;
    for (int i = 0; i < 1000; ++i) {
        dvec3 const axis = glm::normalize(random.vector());
        double const angle = i < 10 ? 1e-13 * i : 3.14 * i / 1000.0;
        EXPECT_LT(glm::distance(log_rotation(exp_rotation(angle * axis)), angle * axis), 1e-9) << angle;
        EXPECT_LT(glm::distance(log_rotation(-exp_rotation(angle * axis)), angle * axis), 1e-9) << angle;
    }
}

TEST(Rotation, HeadingIsAboutTheVertical)
{
    dvec3 const right{1, 0, 0};
    for (double const yaw : {-2.5, 0.0, 0.7})
        for (double const pitch : {-1.57079632679, -1.0, 0.0, 1.2, 1.57079632679}) {
            dquat const turn = exp_rotation({0, yaw, 0});
            EXPECT_LT(
                glm::length(log_rotation(glm::inverse(turn) * heading_of(turn * exp_rotation(pitch * right)))),
                1e-9)
                << yaw << " " << pitch;
        }
}

TEST(RigidPose, InverseUndoes)
{
    RandomPoses pose;
    for (int i = 0; i < 1000; ++i) {
        RigidPose const a = pose(), b = pose(), c = pose();
        EXPECT_LT(distance(inverse(a) * (a * b), b), 1e-12);
        EXPECT_LT(distance(a * inverse(a), {}), 1e-12);
        EXPECT_LT(distance((a * b) * c, a * (b * c)), 1e-12);
        dvec3 const p = pose.vector();
        EXPECT_LT(glm::distance((a * b) * p, a * (b * p)), 1e-12);
    }
}

TEST(RigidPose, IsInterpolatedBetweenItsEnds)
{
    RandomPoses pose;
    for (int i = 0; i < 100; ++i) {
        RigidPose const a = pose(), b = pose(), middle = between(a, b, 0.5);
        EXPECT_LT(distance(between(a, b, 0), a), 1e-12);
        EXPECT_LT(distance(between(a, b, 1), b), 1e-12);
        EXPECT_LT(distance(between(a, middle, 0.5), between(a, b, 0.25)), 1e-9);
    }
}

TEST(RigidPose, KnowsNonsense)
{
    RigidPose p;
    EXPECT_TRUE(is_finite(p));
    p.rotation.z = std::nan("");
    EXPECT_FALSE(is_finite(p));
    EXPECT_FALSE(is_finite({{0, INFINITY, 0}, {1, 0, 0, 0}}));
}

} // namespace
} // namespace gi::test
