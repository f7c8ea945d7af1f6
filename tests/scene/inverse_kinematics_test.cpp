// Two bones: targets reached, bones kept, bent towards the pole, no NaN anywhere, no jumps.

#include "gi/scene/motion/inverse_kinematics.h"

#include <gtest/gtest.h>
#include <random>

namespace gi::test {
namespace {

struct Random {
    std::mt19937_64 engine{7};
    double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine); }
    dvec3 direction()
    {
        std::normal_distribution<double> n;
        dvec3 const v{n(engine), n(engine), n(engine)};
        return glm::length(v) > 0 ? glm::normalize(v) : dvec3{1, 0, 0};
    }
};

void expect_bones(TwoBones const& b, dvec3 root, double upper, double lower)
{
    double const tolerance = 1e-9 * (upper + lower) + 1e-15 * (1 + glm::length(root)); // coordinates are rounded
    ASSERT_TRUE(std::isfinite(glm::length(b.middle)) && std::isfinite(glm::length(b.end)));
    EXPECT_NEAR(glm::distance(root, b.middle), upper, tolerance);
    EXPECT_NEAR(glm::distance(b.middle, b.end), lower, tolerance);
}

TEST(InverseKinematics, TenThousandTargetsWithinReach)
{
    Random r;
    for (int i = 0; i < 10000; ++i) {
        double const scale = std::exp(r.uniform(-5, 5)), upper = scale * r.uniform(0.01, 1),
                     lower = scale * r.uniform(0.01, 1), length = upper + lower;
        dvec3 const root = r.uniform(0, 10) * r.direction(), pole = r.uniform(0.1, 9) * r.direction(),
                    direction = r.direction();
        dvec3 const target = root + r.uniform(std::abs(upper - lower), length) * direction;
        TwoBones const b = reach(root, upper, lower, target, pole);
        expect_bones(b, root, upper, lower);
        EXPECT_LT(glm::distance(b.end, target), 1e-6 * length);
        dvec3 const side = b.middle - root - glm::dot(b.middle - root, direction) * direction;
        EXPECT_GE(glm::dot(side, pole), -1e-9 * length) << "bends away from its pole";
        EXPECT_NEAR(glm::dot(glm::cross(direction, pole), side), 0, 1e-9 * length * glm::length(pole));
    }
}

TEST(InverseKinematics, TargetsBeyondReachAreApproachedStraight)
{
    Random r;
    for (int i = 0; i < 10000; ++i) {
        double const upper = r.uniform(0.1, 1), lower = r.uniform(0.1, 1);
        dvec3 const root = r.direction(), direction = r.direction(), pole = r.direction();
        TwoBones const far =
            reach(root, upper, lower, root + r.uniform(1, 100) * (upper + lower) * direction, pole);
        expect_bones(far, root, upper, lower);
        EXPECT_LT(glm::distance(far.end, root + (upper + lower) * direction), 1e-9);
        double const nearest = std::abs(upper - lower);
        TwoBones const near = reach(root, upper, lower, root + r.uniform(1e-3, 1) * nearest * direction, pole);
        expect_bones(near, root, upper, lower);
        EXPECT_LT(glm::distance(near.end, root + nearest * direction), 1e-9);
    }
}

TEST(InverseKinematics, DegenerateLimbsHaveNoNaN)
{
    dvec3 const root{1, 2, 3},
        points[]{root, root + dvec3{1e-300, 0, 0}, root + dvec3{0, 1e-13, 0}, root + dvec3{0, 0, 1},
                 root + dvec3{0, 1e9, 0}},
        poles[]{{0, 0, 0}, {0, 1, 0}, {0, 0, -3}, {1e-200, 0, 0}};
    double const lengths[]{0, 1e-12, 0.3, 1};
    for (dvec3 const target : points)
        for (dvec3 const pole : poles)
            for (double const upper : lengths)
                for (double const lower : lengths)
                    expect_bones(reach(root, upper, lower, target, pole), root, upper, lower);
}

TEST(InverseKinematics, FoldedOntoItselfTheElbowLiesAlongThePole)
{
    TwoBones const b = reach({1, 2, 3}, 0.5, 0.5, {1, 2, 3}, {0, 0, 4});
    EXPECT_LT(glm::distance(b.middle, dvec3{1, 2, 3.5}), 1e-12);
    EXPECT_LT(glm::distance(b.end, dvec3{1, 2, 3}), 1e-12);
}

/// A right angle by hand: 3-4-5.
TEST(InverseKinematics, RightAngleByHand)
{
    TwoBones const b = reach({0, 0, 0}, 3, 4, {5, 0, 0}, {9, 1, 0});
    EXPECT_LT(glm::distance(b.middle, dvec3{1.8, 2.4, 0}), 1e-12);
}

/// Also through the border of reach, where the middle moves like a square root.
TEST(InverseKinematics, SmoothTargetsMoveTheElbowSmoothly)
{
    Random r;
    for (int path = 0; path < 200; ++path) {
        dvec3 const pole{0, -1, 0}, a = r.direction(), b = r.direction();
        TwoBones before{};
        constexpr int kSteps = 2000;
        for (int i = 0; i <= kSteps; ++i) {
            double const t = 6.28318530717958648 * i / kSteps;
            dvec3 const target = 0.8 * dvec3{std::cos(t), 0.5 * std::sin(2 * t), std::sin(t)} +
                                 0.1 * std::cos(3 * t) * a + 0.15 * std::sin(t) * b;
            TwoBones const now = reach({0, 0, 0}, 0.5, 0.45, target, pole);
            if (i > 0) {
                EXPECT_LT(glm::distance(now.middle, before.middle), 0.1) << path << " " << i;
                EXPECT_LT(glm::distance(now.end, before.end), 0.02) << path << " " << i;
            }
            before = now;
        }
    }
}

TEST(InverseKinematics, TurnsBringDirectionsOntoEachOther)
{
    Random r;
    for (int i = 0; i < 10000; ++i) {
        dvec3 const from = r.uniform(0.01, 10) * r.direction(), hint = r.direction();
        double const off = i % 4 == 0 ? std::exp(r.uniform(-30, 0)) : 1;
        dvec3 to = r.direction();
        if (i % 4 == 0) to = glm::normalize((i % 8 == 0 ? -1.0 : 1.0) * glm::normalize(from) + off * to);
        dquat const q = turn_between(from, to, hint);
        EXPECT_NEAR(glm::length(q), 1, 1e-12);
        EXPECT_LT(glm::distance(q * glm::normalize(from), to), 1e-7);
    }
    EXPECT_EQ(turn_between({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), dquat(1, 0, 0, 0));
    dquat const half = turn_between({1, 0, 0}, {-1, 0, 0}, {0, 1, 0}),
                quarter = glm::slerp(dquat(1, 0, 0, 0), half, 0.5);
    EXPECT_LT(glm::distance(quarter * dvec3{1, 0, 0}, dvec3{0, 1, 0}), 1e-9) << "by way of the hint";
}

} // namespace
} // namespace gi::test
