// Avatars as puppets: joints go where the trackers are.

#include "gi/core/error.h"
#include "gi/core/pose.h"
#include "gi/scene/load/load.h"
#include "tests/support/data.h"
#include "viewer/devices/tracking/known_walk.h"
#include "viewer/devices/tracking/puppet.h"

#include <gtest/gtest.h>

namespace viewer::test {
namespace {

using gi::test::shared_data;

struct Puppet {
    gi::Report report;
    gi::Scene scene;
    gi::AvatarJoints joints;
    gi::Avatar avatar;

    explicit Puppet(std::string const& name)
        : scene(gi::load_scene((shared_data() / "avatars" / name).string(), report)),
          joints(gi::find_avatar_joints(scene)),
          avatar(gi::make_avatar(scene, joints))
    {
    }
    gi::Pose driven(gi::AvatarTargets const& targets) const
    {
        gi::Pose pose = gi::evaluate_pose(scene, std::nullopt);
        gi::drive(scene, avatar, targets, pose);
        return pose;
    }
};

gi::dvec3 place(gi::Pose const& pose, std::int32_t joint) { return pose.world_from_node[std::size_t(joint)][3]; }

TEST(Puppet, TargetsAreInTheWorldAndRigid)
{
    Tracked t;
    t.head = RoomPose{{1, 1.7, 0}, gi::exp_rotation({0, 0.5 * 3.14159265358979, 0})}; // looks along -x
    t.left_hand = RoomPose{{0.6, 1, 0.2}, {1, 0, 0, 0}};
    gi::dmat4 world = glm::mat4_cast(gi::exp_rotation({0, 0.5, 0}));
    world *= 2.0; // twice as large
    world[3] = {10, 0, 5, 1};
    PuppetMeasures m;
    gi::AvatarTargets const targets = puppet_targets(t, world, m);
    // The joint is 8 cm below the eyes and 9 cm behind them: towards +x of the room.
    EXPECT_LT(glm::distance(gi::dvec3((*targets.head)[3]), gi::dvec3(world * glm::dvec4(1.09, 1.62, 0, 1))),
              1e-12);
    EXPECT_NEAR(glm::determinant(glm::dmat3(*targets.head)), 1, 1e-12);
    EXPECT_LT(glm::distance(-gi::dvec3((*targets.head)[2]), gi::exp_rotation({0, 0.5, 0}) * gi::dvec3(-1, 0, 0)),
              1e-12);
    EXPECT_FALSE(targets.right_hand);
    EXPECT_FALSE(puppet_targets({}, world, m).head);

    m.avatar_per_user = 0.5; // a child: half as high, at the same place, hands half as far
    gi::AvatarTargets const child = puppet_targets(t, gi::dmat4(1), m);
    EXPECT_LT(glm::distance(gi::dvec3((*child.head)[3]), gi::dvec3(1.09, 0.81, 0)), 1e-12);
    gi::dvec3 const wrist{0.6, 1, 0.26};
    EXPECT_LT(glm::distance(gi::dvec3((*child.left_hand)[3]),
                            gi::dvec3(1.09, 0.81, 0) + 0.5 * (wrist - gi::dvec3(1.09, 1.62, 0))),
              1e-12);
}

void expect_puppet_follows(std::string const& name)
{
    Puppet const p(name);
    SCOPED_TRACE(name);
    gi::Pose const rest = gi::evaluate_pose(p.scene, std::nullopt);
    PuppetMeasures m;
    m.avatar_per_user = height_scale(p.scene, p.avatar, 1.65, m);
    gi::dmat4 world = glm::mat4_cast(gi::exp_rotation({0, 1, 0}));
    world[3] = {3, 0, -2, 1};

    // Standing upright at eye height: the head joint is as high as the avatar's own at rest.
    Tracked standing;
    standing.head = RoomPose{{0, 1.65, 0}, {1, 0, 0, 0}};
    gi::Pose const upright = p.driven(puppet_targets(standing, world, m));
    EXPECT_NEAR(place(upright, p.joints.head).y, place(rest, p.joints.head).y,
                1e-6 + 0.02 * place(rest, p.joints.head).y);

    int hands = 0;
    for (int i = 0; i < 200; ++i) {
        Tracked const t = known_walk(i * 0.07);
        gi::AvatarTargets const targets = puppet_targets(t, world, m);
        gi::Pose const pose = p.driven(targets);
        EXPECT_LT(glm::distance(place(pose, p.joints.head), gi::dvec3((*targets.head)[3])), 1e-6) << i;
        for (auto const& [joints, target] :
             {std::pair{p.joints.left, targets.left_hand}, {p.joints.right, targets.right_hand}}) {
            double const upper = glm::distance(place(pose, joints.upper), place(pose, joints.lower));
            double const lower = glm::distance(place(pose, joints.lower), place(pose, joints.hand));
            gi::dvec3 const goal((*target)[3]);
            double const far = glm::distance(place(pose, joints.upper), goal);
            if (far > upper + lower || far < std::abs(upper - lower)) continue; // out of reach
            EXPECT_LT(glm::distance(place(pose, joints.hand), goal), 1e-4) << i;
            ++hands;
        }
    }
    testing::Test::RecordProperty("hands_reached", hands);
}

TEST(Puppet, QuaterniusHumanFollows)
{
    LIGHTWELL_NEED_DATA("avatars/quaternius_human.glb");
    expect_puppet_follows("quaternius_human.glb");
}

TEST(Puppet, RobotExpressiveFollows)
{
    LIGHTWELL_NEED_DATA("avatars/robot_expressive.glb");
    expect_puppet_follows("robot_expressive.glb");
}

TEST(Puppet, HeightsThatCannotBeAreRefused)
{
    LIGHTWELL_NEED_DATA("avatars/quaternius_human.glb");
    Puppet const p("quaternius_human.glb");
    for (double const h : {0.0, -1.0, 165.0, double(NAN)})
        EXPECT_THROW(height_scale(p.scene, p.avatar, h), gi::InputError) << h;
}

} // namespace
} // namespace viewer::test
