#include "study/journal/scene_facts.h"

#include <gtest/gtest.h>

namespace study::test {
namespace {

SessionStarted part(std::string const& who, std::string const& digits)
{
    SessionStarted s;
    s.participant_id = who;
    s.about = {{"host", who}, {scene_fact("room.glb"), digits}};
    return s;
}

TEST(SceneFacts, FilesThatChangedBetweenSessionsAreNamed)
{
    SessionStarted const a = part("P001", "12"), b = part("P002", "12"), c = part("P003", "34"), none;
    std::vector<SessionStarted const*> const same{&a, &b, &none}, changed{&a, &b, &c};
    EXPECT_TRUE(changed_scenes(same).empty());
    ASSERT_EQ(changed_scenes(changed).size(), 1u);
    EXPECT_EQ(changed_scenes(changed)[0],
              "the files of scene 'room.glb' have changed: they were others for P003 session 1 than for "
              "P001 session 1; what was shown is not the same");
}

} // namespace
} // namespace study::test
