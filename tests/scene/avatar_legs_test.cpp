// Legs of avatars: feet at given positions, else on the floor.

#include "tests/scene/avatar_figure.h"

namespace gi::test {
namespace {

TEST(AvatarLegs, FeetAtRestLeaveThemAtRest)
{
    for (bool const has_controls : {false, true}) {
        Driven d{Walker(kMixamoLegs, has_controls).scene};
        ASSERT_TRUE(d.avatar.has_legs());
        AvatarTargets t;
        t.left_foot = rigid(place(d.rest, Walker::kLeftFoot), kFacing);
        t.right_foot = rigid(place(d.rest, Walker::kRightFoot), kFacing);
        d.to(t);
        for (std::size_t n = 0; n < d.scene.nodes.size(); ++n)
            for (int c = 0; c < 4; ++c)
                EXPECT_LT(glm::distance(d.pose.world_from_node[n][c], d.rest.world_from_node[n][c]), 1e-6) << n;
    }
}

/// Heads sink, feet stay, knees come forward, further the deeper.
TEST(AvatarLegs, WhoCrouchesKeepsHisFeetOnTheFloor)
{
    for (bool const has_controls : {false, true}) {
        Driven d{Walker(kMixamoLegs, has_controls).scene};
        double knee_before = 0;
        for (double const down : {0.02, 0.1, 0.3, 0.6}) {
            AvatarTargets t;
            t.head = rigid(place(d.rest, Figure::kHead) - dvec3{0, down, 0}, kFacing);
            t.left_foot = rigid(place(d.rest, Walker::kLeftFoot), kFacing);
            t.right_foot = rigid(place(d.rest, Walker::kRightFoot), kFacing);
            d.to(t);
            for (Avatar::Leg const* leg : {&d.avatar.left_leg, &d.avatar.right_leg}) {
                LegJoints const& j = leg->joints;
                EXPECT_LT(glm::distance(place(d.pose, j.foot), place(d.rest, j.foot)), 1e-9);
                EXPECT_NEAR(d.bone(d.pose, j.upper, j.lower), 0.5, 1e-9);
                EXPECT_NEAR(d.bone(d.pose, j.lower, j.foot), 0.45, 1e-9);
                EXPECT_GT(place(d.pose, j.lower).z, knee_before + 0.05) << down;
                EXPECT_NEAR(place(d.pose, j.lower).x, place(d.pose, j.upper).x, 1e-9) << "straight ahead";
            }
            knee_before = std::min(place(d.pose, 10).z, place(d.pose, 13).z);
        }
    }
}

TEST(AvatarLegs, HeelsRiseBeforeFeetLeaveTheFloor)
{
    Driven d{Walker(kMixamoLegs).scene};
    dvec3 const foot = place(d.rest, Walker::kLeftFoot);
    auto const raised = [&](double up) {
        AvatarTargets t;
        t.head = rigid(place(d.rest, Figure::kHead) + dvec3{0, up, 0}, kFacing);
        t.left_foot = rigid(foot, kFacing);
        d.to(t);
        return d.pose.world_from_node[Walker::kLeftFoot];
    };
    dmat4 const flat = raised(0), tiptoe = raised(0.05), jump = raised(0.6);
    // The ball of the foot in the foot's own frame stays where it is.
    glm::dvec4 const ball = glm::inverse(flat) * glm::dvec4(foot + dvec3{0, -0.05, 0.15 * 0.95}, 1);
    EXPECT_LT(glm::distance(tiptoe * ball, flat * ball), 1e-9);
    EXPECT_GT(tiptoe[3].y, flat[3].y + 0.04) << "the heel rises";
    EXPECT_GT((jump * ball).y, (flat * ball).y + 0.3) << "then he jumps";
    EXPECT_NEAR(leg_length(d, d.avatar.left_leg), 0.95, 1e-9) << "and no leg stretches";
    EXPECT_NEAR(d.bone(d.pose, 9, 11), 0.95, 1e-6) << "straight";
}

TEST(AvatarLegs, LostOrImpossibleFeetDoNoHarm)
{
    Driven d{Walker(kMixamoLegs).scene};
    dmat4 lost(1);
    lost[3].y = std::nan("");
    AvatarTargets t;
    t.left_foot = t.right_foot = lost;
    d.to(t);
    EXPECT_EQ(d.pose.world_from_node, d.rest.world_from_node);
    for (dvec3 const at : {dvec3{0.1, 1, 0}, dvec3{1e9, 0, 0}, dvec3{0.1, 3, 0}, dvec3{0.1, 1, 1e-13}}) {
        t.left_foot = t.right_foot = rigid(at, kFacing);
        d.to(t);
        for (dmat4 const& m : d.pose.world_from_node)
            for (int c = 0; c < 4; ++c) EXPECT_TRUE(std::isfinite(glm::length(m[c]))) << at.y << " " << at.z;
        EXPECT_NEAR(leg_length(d, d.avatar.left_leg), 0.95, 1e-6);
    }
}

TEST(AvatarLegs, FeetReachThousandsOfTargets)
{
    Driven d{Walker(kMixamoLegs).scene};
    expect_feet_follow(d, 10000, 1, {});
    Driven controls{Walker(kMixamoLegs, true).scene};
    expect_feet_follow(controls, 1000, 1, {});
}

} // namespace
} // namespace gi::test
