// Joint maps: what they say and refuse, and what is proposed for models whose joints have no usual names.

#include "gi/scene/motion/avatar_map.h"

#include "gi/core/error.h"
#include "gi/scene/generate/generate.h"
#include "gi/scene/load/load.h"
#include "gi/scene/motion/avatar_proposal.h"
#include "tests/scene/avatar_figure.h"
#include "tests/support/data.h"

namespace gi::test {
namespace {

bool same(AvatarJoints const& a, AvatarJoints const& b)
{
    auto const arm = [](ArmJoints const& x, ArmJoints const& y) {
        return x.upper == y.upper && x.lower == y.lower && x.hand == y.hand;
    };
    auto const leg = [](LegJoints const& x, LegJoints const& y) {
        return x.upper == y.upper && x.lower == y.lower && x.foot == y.foot;
    };
    return a.head == b.head && arm(a.left, b.left) && arm(a.right, b.right) && leg(a.left_leg, b.left_leg) &&
           leg(a.right_leg, b.right_leg);
}

/// "head 5, left arm 1 2 3, ..." for messages.
std::string text_of(AvatarJoints const& j)
{
    auto const three = [](char const* what, std::int32_t a, std::int32_t b, std::int32_t c) {
        return std::string(what) + " " + std::to_string(a) + " " + std::to_string(b) + " " + std::to_string(c);
    };
    return "head " + std::to_string(j.head) + three(", left arm", j.left.upper, j.left.lower, j.left.hand) +
           three(", right arm", j.right.upper, j.right.lower, j.right.hand) +
           three(", left leg", j.left_leg.upper, j.left_leg.lower, j.left_leg.foot) +
           three(", right leg", j.right_leg.upper, j.right_leg.lower, j.right_leg.foot);
}

void expect_proposed(Scene const& scene, AvatarJoints const& expected, char const* what)
{
    AvatarProposal const p = propose_avatar_joints(scene);
    EXPECT_TRUE(same(p.joints, expected))
        << what << "\n  proposed " << text_of(p.joints) << "\n  expected " << text_of(expected);
    std::string const map = to_avatar_map(scene, p, "model.glb");
    EXPECT_TRUE(same(parse_avatar_map(map, "map.yaml", scene), p.joints)) << map;
}

/// Names that tell nothing: the numbers of the nodes, or none at all.
Scene renamed(Scene scene, bool numbers)
{
    for (std::size_t n = 0; n < scene.nodes.size(); ++n) scene.nodes[n].name = numbers ? std::to_string(n) : "";
    return scene;
}

/// The whole model in front of a mirror: what was its left is its right.
Scene mirrored(Scene scene)
{
    for (Node& n : scene.nodes) {
        n.translation.x = -n.translation.x;
        n.rotation = dquat(n.rotation.w, n.rotation.x, -n.rotation.y, -n.rotation.z);
    }
    return scene;
}

AvatarJoints swapped(AvatarJoints j)
{
    std::swap(j.left, j.right);
    std::swap(j.left_leg, j.right_leg);
    return j;
}

/// Turns the upper arms by this angle, from one pose at rest (T, A) to another.
Scene with_arms(Scene scene, AvatarJoints const& j, double down_rad)
{
    for (auto const& [upper, sign] : {std::pair{j.left.upper, -1.0}, {j.right.upper, 1.0}}) {
        Pose const rest = evaluate_pose(scene, std::nullopt);
        Node& n = scene.nodes[std::size_t(upper)];
        dquat const parent = n.parent < 0
                                 ? dquat(1, 0, 0, 0)
                                 : glm::quat_cast(glm::dmat3(rest.world_from_node[std::size_t(n.parent)]));
        dquat const turn = glm::angleAxis(sign * down_rad, dvec3{0, 0, 1});
        n.rotation = glm::normalize(glm::inverse(parent) * turn * parent * n.rotation);
    }
    return scene;
}

TEST(AvatarProposal, TheGeneratedAvatarWithoutItsNames)
{
    Scene const avatar = generate_avatar();
    AvatarJoints const known = find_avatar_joints(avatar);
    ASSERT_GE(known.left_leg.foot, 0);
    expect_proposed(avatar, known, "by its names");
    expect_proposed(renamed(avatar, true), known, "numbers only");
    expect_proposed(renamed(avatar, false), known, "no names");
    expect_proposed(renamed(mirrored(avatar), true), swapped(known), "mirrored");
    for (double const down : {-0.5, 0.5, 0.8}) {
        expect_proposed(renamed(with_arms(avatar, known, down), true), known, "other arms at rest");
        expect_proposed(renamed(with_arms(avatar, known, -down), true), known, "other arms at rest");
    }
}

TEST(AvatarProposal, FiguresWithTwistedJoints)
{
    Walker const walker(kMixamoLegs);
    AvatarJoints const known = find_avatar_joints(walker.scene);
    expect_proposed(walker.scene, known, "Mixamo's names");
    AvatarProposal const by_name = propose_avatar_joints(walker.scene);
    EXPECT_NE(by_name.head.reason.find("names"), std::string::npos);
    expect_proposed(renamed(walker.scene, true), known, "numbers");
    Scene sides = renamed(walker.scene, true); // names with sides only, in a figure that looks the other way
    for (auto const& [joint, name] : {std::pair{known.left.upper, "x.R"},
                                      {known.left.lower, "y.R"},
                                      {known.left.hand, "z.R"},
                                      {known.right.upper, "x.L"},
                                      {known.right.lower, "y.L"},
                                      {known.right.hand, "z.L"}})
        sides.nodes[std::size_t(joint)].name = name;
    expect_proposed(sides, swapped(known), "sides by name");
}

TEST(AvatarProposal, ModelsOfOthers)
{
    LIGHTWELL_NEED_DATA("avatars/cesium_man.glb");
    for (char const* file : {"cesium_man.glb", "quaternius_human.glb", "robot_expressive.glb"}) {
        Report report;
        Scene scene = load_scene(shared_data() / "avatars" / file, report);
        AvatarProposal const p = propose_avatar_joints(scene);
        std::string const map = to_avatar_map(scene, p, file);
        EXPECT_TRUE(same(parse_avatar_map(map, "map.yaml", scene), p.joints)) << map;
        EXPECT_NO_THROW(make_avatar(scene, p.joints)) << file;
        if (std::string(file) != "quaternius_human.glb") continue;
        // A Mixamo rig with fingers and end joints, by its shape alone.
        AvatarJoints const known = find_avatar_joints(scene);
        expect_proposed(renamed(scene, true), known, file);
    }
    Report report;
    Scene const man = load_scene(shared_data() / "avatars/cesium_man.glb", report);
    EXPECT_THROW(find_avatar_joints(man), InputError) << "its nodes have no names";
    expect_proposed(man,
                    find_avatar_joints(man, {"node 20",
                                             {"node 16", "node 17", "node 18"},
                                             {"node 13", "node 14", "node 15"},
                                             {"node 7", "node 8", "node 9"},
                                             {"node 3", "node 4", "node 5"}}),
                    "CesiumMan");
    AvatarProposal const p = propose_avatar_joints(man);
    EXPECT_GT(p.arms.confidence, 0.5);
    EXPECT_GT(p.legs.confidence, 0.5);
}

TEST(AvatarProposal, WhatIsNoPersonIsRefused)
{
    Scene chain = renamed(generate_avatar(), true);
    chain.skins[0].joints.resize(1);
    EXPECT_THROW(propose_avatar_joints(chain), InputError);
    EXPECT_THROW(propose_avatar_joints(Scene{}), InputError);
}

TEST(AvatarMap, SaysWhichNodesAndWhereItIsWrong)
{
    Scene const scene = renamed(Walker(kMixamoLegs).scene, true);
    auto const parsed = [&](std::string const& text) { return parse_avatar_map(text, "m.yaml", scene); };
    std::string const arms = "left_arm: {upper: \"3\", lower: \"4\", hand: \"#5\"}\n"
                             "right_arm: {upper: \"6\", lower: \"7\", hand: \"8\"}\n";
    AvatarJoints const j = parsed("head: \"2\"\n" + arms);
    EXPECT_EQ(j.head, 2);
    EXPECT_EQ(j.left.hand, 5);
    EXPECT_EQ(j.left_leg.foot, -1);
    struct {
        std::string text, message;
    } const cases[] = {
        {"head: nose\n" + arms, "m.yaml:1:7: there is no node 'nose'"},
        {"head: \"#99\"\n" + arms, "m.yaml:1:7: there is no node #99 (the model has 15 nodes, from #0)"},
        {"head: \"3\"\n" + arms, "m.yaml:2:19: node '3' twice (it is"},
        {"head: \"2\"\nleft_arm: {upper: \"4\", lower: \"3\", hand: \"5\"}\n",
         "m.yaml:2:11: the joints form no chain"},
        {"head: \"2\"\nleft_arm: {upper: \"3\", lower: \"4\"}\n", "hand"},
        {"head: \"2\"\n" + arms + "left_leg: {upper: \"9\", lower: \"10\", foot: \"11\"}\n",
         "m.yaml:1:1: only one leg (an avatar has two legs or none) add right_leg"},
        {"neck: \"2\"\n" + arms, "m.yaml:1:1: "},
        {"head: \"2\"\n", "m.yaml:1:1: the map is not complete: the avatar has no"},
        {"head: [", "m.yaml:"},
    };
    for (auto const& c : cases) {
        std::string message = "nothing";
        try {
            parsed(c.text);
        } catch (InputError const& e) {
            message = e.what();
        }
        EXPECT_NE(message.find(c.message), std::string::npos) << c.text << "\n  says: " << message;
    }
    Scene twins = scene;
    twins.nodes[4].name = "3";
    try {
        parse_avatar_map("head: \"3\"\n" + arms, "m.yaml", twins);
        ADD_FAILURE();
    } catch (InputError const& e) {
        EXPECT_NE(std::string(e.what()).find("2 nodes are called '3'"), std::string::npos) << e.what();
    }
    // Only what is unusual has to be said.
    Scene const usual = Walker(kMixamoLegs).scene;
    EXPECT_TRUE(same(parse_avatar_map("head: mixamorig:Head\n", "m.yaml", usual), find_avatar_joints(usual)));
}

} // namespace
} // namespace gi::test
