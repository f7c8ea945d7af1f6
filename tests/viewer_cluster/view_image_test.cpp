// `mpirun -n N lightwell view`, as far as it comes without screens.

#include "tests/support/xvfb.h"
#include "tests/viewer_cluster/mpirun.h"

#include <fstream>
#include <nlohmann/json.hpp>

namespace viewer::test {
namespace {

TEST(ViewByRanks, TooFewForTheWindowsAreRefusedOnce)
{
    if (!has_mpirun()) GTEST_SKIP() << "no mpirun here: several machines are not tested";
    TemporaryFolder const folder;
    Mpirun mpirun(2, "",
                  LIGHTWELL_PROGRAM " view cornell --display " LIGHTWELL_SOURCE_DIR "/data/displays/cave4.yaml",
                  folder.path());
    EXPECT_EQ(mpirun.wait(std::chrono::seconds(60)), 2);
    std::string const said = mpirun.text();
    std::string const problem = "windows 'right', 'floor' belong to ranks 2, 3, but there are 2 ranks";
    EXPECT_NE(said.find(problem), std::string::npos) << said;
    EXPECT_EQ(said.find(problem), said.rfind(problem)) << "said once\n" << said;
    EXPECT_NE(said.find("start with mpirun -n 4"), std::string::npos) << said;
}

/// Two walls on one screen, one for each rank, in front of a scene whose texture is missing.
class ViewOnTwoRanks : public testing::Test {
protected:
    void SetUp() override
    {
        if (!has_mpirun()) GTEST_SKIP() << "no mpirun here: several machines are not tested";
        server = std::make_unique<gi::test::Xvfb>(500, 300);
        if (!server->problem().empty()) GTEST_SKIP() << "SKIPPED: " << server->problem();
        std::ofstream(folder / "room.yaml") << R"(walls:
  - {name: front, window: a, lower_left_m: [-1, 0, -1], lower_right_m: [1, 0, -1], upper_left_m: [-1, 2, -1]}
  - {name: right, window: b, rank: 1, lower_left_m: [1, 0, -1], lower_right_m: [1, 0, 1], upper_left_m: [1, 2, -1]}
windows:
  - {name: a, size_px: [160, 120]}
  - {name: b, size_px: [160, 120], position_px: [200, 0]}
users:
  - {name: u, head_position_m: [0, 1, 0.5]}
)";
        std::ofstream(folder / "paper.mtl") << "newmtl paper\nmap_Kd nowhere.png\n";
        std::ofstream(folder / "paper.obj") << "mtllib paper.mtl\nusemtl paper\nv -1 0 -3\nv 1 0 -3\nv 0 2 -3\n"
                                               "vt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n";
    }

    TemporaryFolder folder;
    std::unique_ptr<gi::test::Xvfb> server;
};

TEST_F(ViewOnTwoRanks, StatisticsHaveTheLossesOfEachRankAndAllFrames)
{
    Mpirun mpirun(2, "", LIGHTWELL_PROGRAM " view paper.obj --display room.yaml --time-limit 8 --stats s.json",
                  folder.path());
    EXPECT_EQ(mpirun.wait(std::chrono::seconds(60)), 0) << mpirun.text();
    auto const stats = nlohmann::json::parse(file_text(folder / "s.json"));
    EXPECT_GT(stats["frames"]["frames"], 0) << "without --frame-log";
    EXPECT_GT(stats["frames"]["max_ms"], 0.0);
    ASSERT_EQ(stats["ranks"].size(), 2u) << stats;
    for (std::size_t r = 0; r < 2; ++r) {
        EXPECT_EQ(stats["ranks"][r]["rank"], r);
        EXPECT_FALSE(stats["ranks"][r]["losses"].empty()) << stats;
        EXPECT_FALSE(stats["ranks"][r].contains("lost"));
    }
    EXPECT_EQ(stats["ranks"][1]["losses"].begin().key(), stats["report"]["losses"].begin().key());
}

} // namespace
} // namespace viewer::test
