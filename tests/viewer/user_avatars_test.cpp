// Who has which avatar: by options, by display files, by recordings of now and of before further users had any.

#include "viewer/app/user_avatars.h"

#include "gi/core/error.h"
#include "gi/scene/load/load.h"
#include "gi/scene/motion/avatar_proposal.h"
#include "tests/viewer/run_program.h"

#include <fstream>
#include <gtest/gtest.h>

namespace viewer::test {
namespace {

Display two_users()
{
    Display d;
    d.users.resize(2);
    d.users[0].head.translation_m = {0, 1.7, 0};
    d.users[1].head.translation_m = {1, 0.1, 0};
    d.users[0].avatar = d.users[1].avatar = "avatar";
    d.users[1].eye_height_m = 1.85;
    return d;
}

TEST(UserAvatars, ThoseOfADisplayAndOfTheOption)
{
    std::vector<AvatarChoice> const none;
    EXPECT_EQ(avatar_choices("", 1.6, std::nullopt, ""), none);
    EXPECT_EQ(avatar_choices("a.glb", 1.6, std::nullopt, ""), (std::vector<AvatarChoice>{{0, "a.glb", 1.6}}));
    EXPECT_EQ(avatar_choices("", 1.6, two_users(), ""),
              (std::vector<AvatarChoice>{{0, "avatar", 1.7}, {1, "avatar", 1.85, false}}));
    EXPECT_EQ(avatar_choices("a.glb", 1.6, two_users(), ""),
              (std::vector<AvatarChoice>{{0, "a.glb", 1.7}, {1, "avatar", 1.85, false}}))
        << "the option is the first user's";
    Display floating = two_users();
    floating.users[1].eye_height_m.reset();
    EXPECT_EQ(avatar_choices("", 1.6, floating, "").at(1).eye_height_m, 1.6) << "a head that rests at the floor";
}

TEST(UserAvatars, RecordingsKeepThem)
{
    std::vector<AvatarChoice> const all{{0, "a.glb", 1.7}, {2, "avatar", 1.85}};
    nlohmann::json load{{"background", "black"}};
    put_avatars(load, all);
    EXPECT_EQ(avatars_of(load), all);
    EXPECT_EQ(avatars_of({{"avatar", "a.glb"}, {"eye_height_m", 1.7}}),
              (std::vector<AvatarChoice>{{0, "a.glb", 1.7}}))
        << "of before";
    nlohmann::json others = nlohmann::json::object();
    put_avatars(others, {{1, "avatar", 1.6}});
    EXPECT_EQ(avatars_of(others), (std::vector<AvatarChoice>{{1, "avatar", 1.6}}));
    std::vector<AvatarChoice> const mapped{{0, "a.glb", 1.7, true, "a.yaml"}, {1, "b.glb", 1.6, true, "b.yaml"}};
    nlohmann::json with_maps;
    put_avatars(with_maps, mapped);
    EXPECT_EQ(avatars_of(with_maps), mapped);
    EXPECT_TRUE(avatars_of(nlohmann::json::object()).empty());
}

TEST(UserAvatars, FeetAreAskedForWhereTheRoomHasItsFloorAtZero)
{
    gi::Report report;
    RenderOptions const options;
    RecordedScenes const scenes = scenes_with(options, avatar_choices("", 1.6, two_users(), ""), report);
    ASSERT_EQ(scenes.avatars.size(), 2u);
    EXPECT_TRUE(scenes.avatars[0].stance.has_value());
    EXPECT_FALSE(scenes.avatars[1].stance.has_value());
    EXPECT_EQ(resting_eye_height_m(two_users(), 1.6), 1.7);
}

TEST(UserAvatars, DamagedRecordingsAreRefused)
{
    using AnyJson = nlohmann::json;
    for (AnyJson const& load :
         {AnyJson{{"avatar", 5}}, AnyJson{{"avatar", "a.glb"}, {"eye_height_m", "x"}}, AnyJson{{"avatars", 5}},
          AnyJson{{"avatars", {"x"}}}, AnyJson{{"avatars", {{{"avatar", "a.glb"}, {"user", 100}}}}},
          AnyJson{{"avatar", "a.glb"}, {"avatars", {{{"avatar", "b.glb"}, {"user", 0}}}}},
          AnyJson{{"avatars", {{{"avatar", "a.glb"}, {"user", 2}}, {{"avatar", "b.glb"}, {"user", 2}}}}}})
        EXPECT_THROW(avatars_of(load), gi::InputError) << load.dump();
}

TEST(UserAvatars, HaveJointMaps)
{
    TemporaryFolder const folder;
    Display d = two_users();
    d.users[1].avatar_joints = "guide.yaml";
    EXPECT_EQ(avatar_choices("a.glb", 1.6, d, "room", "a.yaml"),
              (std::vector<AvatarChoice>{{0, "a.glb", 1.7, true, "a.yaml"},
                                         {1, "avatar", 1.85, false, "room/guide.yaml"}}));
    gi::Report report;
    auto const scenes = [&](std::string const& map) {
        std::ofstream(folder / "j.yaml") << map;
        return scenes_with({}, {{0, "avatar", 1.7, true, (folder / "j.yaml").string()}}, report);
    };
    gi::Scene const avatar = gi::load_scene("avatar", report);
    EXPECT_TRUE(scenes(gi::to_avatar_map(avatar, gi::propose_avatar_joints(avatar), "avatar")).avatars[0].stance);
    try {
        scenes("head: nose\n");
        ADD_FAILURE();
    } catch (gi::InputError const& e) {
        EXPECT_NE(std::string(e.what()).find("j.yaml:1:7: there is no node 'nose'"), std::string::npos)
            << e.what();
    }
}

TEST(UserAvatars, MapsAreProposedByACommand)
{
    TemporaryFolder const folder;
    EXPECT_NE(run_well("avatar map avatar", folder.path()).out.find("head: \"head\""), std::string::npos);
    run_well("avatar map avatar --out j.yaml", folder.path());
    EXPECT_NE(file_text(folder / "j.yaml").find("left_arm: {upper: "), std::string::npos);
    EXPECT_EQ(run("avatar map nowhere.glb", folder.path()).code, 2);
    Outcome const o = run("avatar map cornell", folder.path());
    EXPECT_EQ(o.code, 2);
    EXPECT_NE(o.err.find("there is no avatar 'cornell'"), std::string::npos) << o.err;
    EXPECT_EQ(run("view mirror --avatar-joints j.yaml", folder.path()).code, 2) << "of which avatar?";
}

} // namespace
} // namespace viewer::test
