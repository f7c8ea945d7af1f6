// Avatars driven by trackers: heads and hands at given poses; real ones with their feet too.

#include "gi/scene/load/load.h"
#include "tests/scene/avatar_figure.h"
#include "tests/support/data.h"

namespace gi::test {
namespace {

/// Where its trackers are at rest, nothing moves.
TEST(AvatarDrive, TrackersAtRestLeaveItAtRest)
{
    Driven d{Figure(kMixamo).scene};
    dquat const looks = glm::angleAxis(glm::pi<double>(), dvec3{0, 1, 0}); // -Z to +Z
    d.to({rigid(place(d.rest, Figure::kHead), looks), {}, {}});
    for (std::size_t n = 0; n < d.scene.nodes.size(); ++n)
        for (int c = 0; c < 4; ++c)
            EXPECT_LT(glm::distance(d.pose.world_from_node[n][c], d.rest.world_from_node[n][c]), 1e-9) << n;
    d.to({});
    EXPECT_EQ(d.pose.world_from_node, d.rest.world_from_node);
}

TEST(AvatarDrive, LookingAsideTurnsTheBodyAndNoddingDoesNot)
{
    Driven d{Figure(kMixamo).scene};
    dquat const to_x = glm::angleAxis(-glm::half_pi<double>(), dvec3{0, 1, 0}); // -Z to +X
    for (double const nod : {0.0, 0.6, -1.5}) {
        d.to({rigid({5, 1.4, 5}, to_x * glm::angleAxis(nod, dvec3{1, 0, 0})), {}, {}});
        EXPECT_LT(glm::distance(place(d.pose, Figure::kHead), dvec3{5, 1.4, 5}), 1e-9);
        dvec3 const left = place(d.pose, 3) - place(d.pose, 6);
        EXPECT_LT(glm::distance(left, dvec3{0, 0, -0.4}), 1e-9) << "its left is -Z where it faces +X";
    }
}

TEST(AvatarDrive, HeadsTurnAsTheirTrackers)
{
    Driven d{Figure(kMixamo).scene};
    dquat const a = glm::normalize(dquat(0.9, 0.1, 0.3, -0.2)), b = glm::normalize(dquat(0.2, -0.5, 0.7, 0.1));
    d.to({rigid({0, 1, 0}, a), {}, {}});
    glm::dmat3 const head_a(d.pose.world_from_node[Figure::kHead]);
    d.to({rigid({0, 1, 0}, b), {}, {}});
    glm::dmat3 const head_b(d.pose.world_from_node[Figure::kHead]);
    glm::dmat3 const between = glm::mat3_cast(b * glm::inverse(a)) * head_a;
    for (int c = 0; c < 3; ++c) EXPECT_LT(glm::distance(between[c], head_b[c]), 1e-9);
}

TEST(AvatarDrive, HandsReachThousandsOfTargets)
{
    Driven d{Figure(kMixamo).scene};
    expect_hands_follow(d, 5000, 1, {});
}

TEST(AvatarDrive, HandsTurnAsTheirTrackers)
{
    Driven d{Figure(kMixamo).scene};
    // Fingers along +X, back of the hand up: as at rest but for the bend of the elbow.
    dquat const out = glm::quat_cast(glm::dmat3(dvec3{0, 0, 1}, dvec3{0, 1, 0}, dvec3{-1, 0, 0}));
    d.to({{}, rigid({0.6, 1.2, 0.2}, out), {}});
    dmat4 const spread = d.pose.world_from_node[Figure::kLeftHand];
    dquat const down = glm::angleAxis(-glm::half_pi<double>(), dvec3{0, 0, 1}) * out;
    d.to({{}, rigid({0.6, 1.2, 0.2}, down), {}});
    dmat4 const turned = glm::mat4_cast(down * glm::inverse(out)) * spread;
    for (int c = 0; c < 3; ++c)
        EXPECT_LT(glm::distance(turned[c], d.pose.world_from_node[Figure::kLeftHand][c]), 1e-9);
}

TEST(AvatarDrive, ElbowsHangDown)
{
    Driven d{Figure(kMixamo).scene};
    d.to({{}, rigid({0.2, 1.5, 0.4}, {1, 0, 0, 0}), rigid({-0.2, 1.5, 0.4}, {1, 0, 0, 0})});
    EXPECT_LT(place(d.pose, 4).y, 1.5 - 0.1);
    EXPECT_LT(place(d.pose, 7).y, 1.5 - 0.1);
    EXPECT_NEAR(place(d.pose, 4).x, -place(d.pose, 7).x, 1e-9) << "both sides alike";
}

TEST(AvatarDrive, LostOrImpossibleTrackersDoNoHarm)
{
    Driven d{Figure(kMixamo).scene};
    dmat4 lost(1);
    lost[3].x = std::nan("");
    d.to({lost, lost, lost});
    EXPECT_EQ(d.pose.world_from_node, d.rest.world_from_node);
    for (dmat4 const& strange :
         {dmat4(0.0), rigid({1e9, 0, 0}, {1, 0, 0, 0}), rigid(place(d.rest, 3), {1, 0, 0, 0})}) {
        d.to({strange, strange, strange});
        for (dmat4 const& m : d.pose.world_from_node)
            for (int c = 0; c < 4; ++c) EXPECT_TRUE(std::isfinite(glm::length(m[c])));
    }
}

/// A wave of the hand in steps of a few millimetres moves no joint by more than centimetres.
TEST(AvatarDrive, SmoothTrackersMoveSmoothly)
{
    Driven d{Figure(kMixamo).scene};
    Pose before;
    for (int i = 0; i <= 2000; ++i) {
        double const t = 6.28318530717958648 * i / 2000;
        dquat const turn = glm::angleAxis(glm::pi<double>() + 0.5 * std::sin(t), dvec3{0, 1, 0});
        d.to({rigid({0.1 * std::sin(t), 1.6, 0}, turn),
              rigid({0.25 + 0.2 * std::sin(2 * t), 1.4 + 0.2 * std::cos(t), 0.35}, turn),
              {}});
        if (i > 0) {
            for (std::size_t n = 0; n < d.scene.nodes.size(); ++n)
                for (int c = 0; c < 4; ++c)
                    EXPECT_LT(glm::distance(d.pose.world_from_node[n][c], before.world_from_node[n][c]), 0.02)
                        << i;
        }
        before = d.pose;
    }
}

void expect_real(std::string const& name, AvatarNames const& names)
{
    Report report;
    Scene scene = load_scene((shared_data() / "avatars" / name).string(), report);
    Driven d{std::move(scene), names};
    SCOPED_TRACE(name);
    expect_hands_follow(d, 300, d.bone(d.rest, d.avatar.left.joints.upper, d.avatar.left.joints.hand),
                        {0.0, 0.4, 0.9});
    ASSERT_TRUE(d.avatar.has_legs());
    expect_feet_follow(d, 300, leg_length(d, d.avatar.left_leg), {});
}

TEST(AvatarDrive, QuaterniusHuman)
{
    LIGHTWELL_NEED_DATA("avatars/quaternius_human.glb");
    expect_real("quaternius_human.glb", {});
}

TEST(AvatarDrive, RobotExpressive)
{
    LIGHTWELL_NEED_DATA("avatars/robot_expressive.glb");
    expect_real("robot_expressive.glb", {});
}

TEST(AvatarDrive, CesiumManByExplicitNames)
{
    LIGHTWELL_NEED_DATA("avatars/cesium_man.glb");
    expect_real("cesium_man.glb", {"node 20",
                                   {"node 16", "node 17", "node 18"},
                                   {"node 13", "node 14", "node 15"},
                                   {"node 7", "node 8", "node 9"},
                                   {"node 3", "node 4", "node 5"}});
}

} // namespace
} // namespace gi::test
