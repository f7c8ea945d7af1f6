#pragma once
// Figures whose joints are known, driven as avatars by trackers.

#include "gi/scene/motion/avatar.h"

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>
#include <random>

namespace gi::test {

/// A standing figure in T-pose, facing +Z: hips, head, two arms of 0.3 + 0.25 m. Names in the order of `names`.
struct Figure {
    static constexpr int kHips = 1, kHead = 2, kLeftHand = 5, kRightHand = 8;
    Scene scene;

    explicit Figure(std::vector<std::string> const& names)
    {
        auto const add = [&](std::int32_t parent, dvec3 translation, dquat rotation = {1, 0, 0, 0}) {
            Node n;
            n.parent = parent;
            n.translation = translation;
            n.rotation = rotation;
            std::size_t const i = scene.nodes.size();
            n.name = i == 0 ? "root" : i <= names.size() ? names[i - 1] : "tip";
            scene.nodes.push_back(n);
        };
        dquat const twist = glm::angleAxis(0.7, glm::normalize(dvec3{1, 2, 3}));
        add(-1, {0, 0, 0});
        add(0, {0, 1, 0});                                        // 1 hips
        add(1, {0, 0.6, 0}, twist);                               // 2 head, with axes of its own
        add(1, {0.2, 0.5, 0});                                    // 3 left arm
        add(3, {0.3, 0, 0}, glm::angleAxis(0.2, dvec3{0, 1, 0})); // 4, bent a little
        add(4, {0.25, 0, 0}, twist);                              // 5
        add(1, {-0.2, 0.5, 0});                                   // 6 right arm
        add(6, {-0.3, 0, 0}, glm::angleAxis(-0.2, dvec3{0, 1, 0}));
        add(7, {-0.25, 0, 0}, glm::inverse(twist)); // 8
        Skin skin;
        skin.joints = {1, 2, 3, 4, 5, 6, 7, 8};
        skin.inverse_bind.assign(8, mat4(1));
        scene.skins = {skin};
    }
};

inline std::vector<std::string> const kMixamo{"mixamorig:Hips",         "mixamorig:Head",     "mixamorig:LeftArm",
                                              "mixamorig:LeftForeArm",  "mixamorig:LeftHand", "mixamorig:RightArm",
                                              "mixamorig:RightForeArm", "mixamorig:RightHand"};

/// The same with legs of 0.5 + 0.45 m that hang straight, feet at 0.05 m; the right foot below its shin or, as in
/// rigs with controls, below the root.
struct Walker : Figure {
    static constexpr int kLeftFoot = 11, kRightFoot = 14;

    explicit Walker(std::vector<std::string> const& names, bool has_controls = false) : Figure(kMixamo)
    {
        dquat const twist = glm::angleAxis(0.4, glm::normalize(dvec3{2, -1, 1}));
        auto const add = [&](std::int32_t parent, dvec3 translation, dquat rotation = {1, 0, 0, 0}) {
            Node n;
            n.parent = parent;
            n.translation = translation;
            n.rotation = rotation;
            n.name = names[scene.nodes.size() - 9];
            scene.skins[0].joints.push_back(std::int32_t(scene.nodes.size()));
            scene.skins[0].inverse_bind.emplace_back(1);
            scene.nodes.push_back(n);
        };
        add(1, {0.1, 0, 0}); // 9 left thigh
        add(9, {0, -0.5, 0});
        add(10, {0, -0.45, 0}, twist); // 11
        add(1, {-0.1, 0, 0});          // 12 right thigh
        add(12, {0, -0.5, 0}, twist);
        if (has_controls)
            add(0, {-0.1, 0.05, 0}, twist); // 14
        else
            add(13, glm::inverse(twist) * dvec3{0, -0.45, 0});
    }
};

inline std::vector<std::string> const kMixamoLegs{"mixamorig:LeftUpLeg", "mixamorig:LeftLeg",
                                                  "mixamorig:LeftFoot",  "mixamorig:RightUpLeg",
                                                  "mixamorig:RightLeg",  "mixamorig:RightFoot"};

inline dmat4 rigid(dvec3 position, dquat const& rotation)
{
    dmat4 m = glm::mat4_cast(rotation);
    m[3] = glm::dvec4(position, 1);
    return m;
}

inline dvec3 place(Pose const& pose, std::int32_t node)
{
    return dvec3(pose.world_from_node[std::size_t(node)][3]);
}

struct Driven {
    Scene scene;
    Avatar avatar;
    Pose rest, pose;

    explicit Driven(Scene s, AvatarNames const& names = {})
        : scene(std::move(s)),
          avatar(make_avatar(scene, find_avatar_joints(scene, names))),
          rest(evaluate_pose(scene, std::nullopt)),
          pose(rest)
    {
    }
    void to(AvatarTargets const& targets, std::optional<double> time_s = std::nullopt)
    {
        pose = evaluate_pose(scene, time_s);
        drive(scene, avatar, targets, pose);
    }
    double bone(Pose const& p, std::int32_t a, std::int32_t b) const
    {
        return glm::distance(place(p, a), place(p, b));
    }
};

inline dquat const kFacing = glm::angleAxis(glm::pi<double>(), dvec3{0, 1, 0}); // -Z to +Z, as at rest

inline double leg_length(Driven const& d, Avatar::Leg const& leg)
{
    return d.bone(d.pose, leg.joints.upper, leg.joints.lower) + d.bone(d.pose, leg.joints.lower, leg.joints.foot);
}

inline void expect_hands_follow(Driven& d, int count, double scale, std::vector<double> const& times)
{
    std::mt19937_64 engine(5);
    std::normal_distribution<double> normal;
    auto const random_point = [&] { return dvec3{normal(engine), normal(engine), normal(engine)}; };
    auto const random_turn = [&] {
        return glm::normalize(dquat(normal(engine), normal(engine), normal(engine), normal(engine)));
    };
    for (int i = 0; i < count; ++i) {
        std::optional<double> time;
        if (!times.empty()) time = times[std::size_t(i) % times.size()];
        Pose const before = evaluate_pose(d.scene, time);
        AvatarTargets t;
        if (i % 3 > 0) t.head = rigid(place(d.rest, d.avatar.head) + scale * random_point(), random_turn());
        d.to(t, time);
        for (Avatar::Arm const* arm : {&d.avatar.left, &d.avatar.right}) {
            ArmJoints const& j = arm->joints;
            double const upper = d.bone(before, j.upper, j.lower), lower = d.bone(before, j.lower, j.hand);
            dvec3 const shoulder = place(d.pose, j.upper);
            double const share = std::uniform_real_distribution<double>(0, 1)(engine);
            double const distance = std::abs(upper - lower) + share * (upper + lower - std::abs(upper - lower));
            dvec3 const target = shoulder + distance * glm::normalize(random_point());
            (arm->outward > 0 ? t.left_hand : t.right_hand) = rigid(target, random_turn());
        }
        d.to(t, time);
        for (Avatar::Arm const* arm : {&d.avatar.left, &d.avatar.right}) {
            ArmJoints const& j = arm->joints;
            double const upper = d.bone(before, j.upper, j.lower), lower = d.bone(before, j.lower, j.hand);
            dvec3 const target((arm->outward > 0 ? t.left_hand : t.right_hand)->operator[](3));
            EXPECT_LT(glm::distance(place(d.pose, j.hand), target), 1e-6 * (upper + lower)) << i;
            EXPECT_NEAR(d.bone(d.pose, j.upper, j.lower), upper, 1e-6 * upper) << i;
            EXPECT_NEAR(d.bone(d.pose, j.lower, j.hand), lower, 1e-6 * lower) << i;
        }
    }
}

/// Anywhere around the hips: what can be reached is, whatever else is finite, bones keep their lengths.
inline void expect_feet_follow(Driven& d, int count, double scale, std::optional<double> time)
{
    std::mt19937_64 engine(7);
    std::normal_distribution<double> normal;
    auto const random_point = [&] { return dvec3{normal(engine), normal(engine), normal(engine)}; };
    auto const random_turn = [&] {
        return glm::normalize(dquat(normal(engine), normal(engine), normal(engine), normal(engine)));
    };
    Pose const before = evaluate_pose(d.scene, time);
    int reached = 0;
    for (int i = 0; i < count; ++i) {
        AvatarTargets t;
        if (i % 3 > 0) t.head = rigid(place(d.rest, d.avatar.head) + scale * random_point(), random_turn());
        d.to(t, time);
        dvec3 const middle =
            0.5 * (place(d.pose, d.avatar.left_leg.joints.upper) + place(d.pose, d.avatar.right_leg.joints.upper));
        t.left_foot = rigid(middle + 0.6 * scale * random_point(), random_turn());
        t.right_foot = rigid(middle + 0.6 * scale * random_point(), random_turn());
        d.to(t, time);
        for (Avatar::Leg const* leg : {&d.avatar.left_leg, &d.avatar.right_leg}) {
            LegJoints const& j = leg->joints;
            double const upper = d.bone(before, j.upper, j.lower), lower = d.bone(before, j.lower, j.foot);
            dvec3 const goal((leg == &d.avatar.left_leg ? t.left_foot : t.right_foot)->operator[](3));
            double const far = glm::distance(goal, place(d.pose, j.upper));
            if (far < upper + lower && far > std::abs(upper - lower)) {
                EXPECT_LT(glm::distance(place(d.pose, j.foot), goal), 1e-3 * scale) << i;
                ++reached;
            }
            EXPECT_NEAR(d.bone(d.pose, j.upper, j.lower), upper, 1e-6 * upper) << i;
            EXPECT_NEAR(d.bone(d.pose, j.lower, j.foot), lower, 1e-6 * lower) << i;
        }
        for (dmat4 const& m : d.pose.world_from_node)
            for (int c = 0; c < 4; ++c) ASSERT_TRUE(std::isfinite(glm::length(m[c]))) << i;
    }
    EXPECT_GT(reached, count / 4);
}

} // namespace gi::test
