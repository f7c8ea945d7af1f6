#include "ar/pose/align.h"

#include "ar/base/error.h"
#include "ar/base/rotation_fit.h"

#include <cmath>
#include <gtest/gtest.h>
#include <random>

namespace ar::test {
namespace {

Pose const kTruth{exp_rotation({0.4, -1.2, 2.0}), {3, -1, 2}};

std::vector<Pose> some_poses(std::size_t n)
{
    std::mt19937 random(2);
    std::uniform_real_distribution<double> u(-1, 1);
    std::vector<Pose> poses;
    for (std::size_t i = 0; i < n; ++i)
        poses.push_back({exp_rotation({u(random), u(random), u(random)}), {u(random), u(random), u(random)}});
    return poses;
}

TEST(Alignment, OfPointsIsFoundWithItsScale)
{
    std::vector<glm::dvec3> from, to;
    for (Pose const& p : some_poses(6)) {
        from.push_back(p.position_m);
        to.push_back(2.5 * (kTruth.rotation * p.position_m) + kTruth.position_m);
    }
    Alignment const a = align(from, to, Scale::free);
    EXPECT_NEAR(a.scale, 2.5, 1e-12);
    EXPECT_LT(angle_between_deg(a.to_from.rotation, kTruth.rotation), 1e-6);
    EXPECT_LT(a.rms_m, 1e-12);
    to[4].y += 0.1;
    Alignment const off = align(from, to, Scale::free);
    EXPECT_EQ(off.worst, 4u);
    EXPECT_GT(off.residual_m[4], 0.03);
    EXPECT_GT(align(from, to).rms_m, 0.5); // its scale is not 1
}

TEST(Alignment, NeverMirrors)
{
    std::vector<glm::dvec3> const from{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1.5}};
    std::vector<glm::dvec3> to = from;
    for (auto& p : to) p.x = -p.x;
    Alignment const a = align(from, to);
    EXPECT_GT(a.rms_m, 0.1);
    EXPECT_NEAR(glm::determinant(glm::mat3_cast(a.to_from.rotation)), 1, 1e-12);
}

TEST(Alignment, OfPosesNeedsButOne)
{
    for (std::size_t n : {1u, 2u, 5u}) {
        std::vector<Pose> const from = some_poses(n);
        std::vector<Pose> to;
        for (Pose const& p : from) to.push_back(kTruth * p);
        Alignment const a = align(from, to);
        EXPECT_LT(angle_between_deg(a.to_from.rotation, kTruth.rotation), 1e-6);
        EXPECT_LT(glm::length(a.to_from.position_m - kTruth.position_m), 1e-9);
        EXPECT_LT(a.residual_deg[0], 1e-5);
    }
}

TEST(Alignment, OfTooLittleIsRefused)
{
    std::vector<glm::dvec3> const two{{0, 0, 0}, {1, 0, 0}}, line{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}},
        bad{{0, 0, 0}, {1, 0, 0}, {0, NAN, 0}};
    EXPECT_THROW(align(two, two), InputError);
    EXPECT_THROW(align(line, line), InputError);
    EXPECT_THROW(align(line, two), InputError);
    EXPECT_THROW(align(bad, bad), InputError);
    EXPECT_THROW(align(std::span<Pose const>{}, std::span<Pose const>{}), InputError);
}

} // namespace
} // namespace ar::test
