// `mpirun -n N lightwell view`, as far as it comes without screens.

#include "gi/core/error.h"
#include "tests/support/xvfb.h"
#include "tests/viewer_cluster/mpirun.h"
#include "tests/viewer_show/two_walls.h"
#include "viewer/protocol/remote/remote_client.h"

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

/// The remote control of the leader; waits until it listens.
class Leader {
public:
    explicit Leader(std::filesystem::path const& socket)
    {
        auto const end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
        while (!client_) {
            try {
                client_.emplace(socket.string());
            } catch (gi::InputError const&) {
                if (std::chrono::steady_clock::now() > end) throw;
                std::this_thread::sleep_for(std::chrono::milliseconds(20));
            }
        }
    }
    nlohmann::json ask(nlohmann::json const& request)
    {
        nlohmann::json const a = client_->ask(request, std::chrono::seconds(60));
        EXPECT_TRUE(a.contains("result")) << request << " -> " << a;
        return a.value("result", nlohmann::json::object());
    }
    void settle()
    {
        int at_rest = 0;
        auto const end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
        while (at_rest < 8 && std::chrono::steady_clock::now() < end) {
            at_rest = ask({{"do", "stats"}}).value("at_rest", false) ? at_rest + 1 : 0;
            std::this_thread::sleep_for(std::chrono::milliseconds(50));
        }
        EXPECT_EQ(at_rest, 8) << "the picture does not come to rest";
    }

private:
    std::optional<RemoteClient> client_;
};

/// Of pictures that take longer than a tracker's silence may: the head is followed none the less.
TEST_F(ViewOnTwoRanks, SurfacesOfAMovingHeadAreShownInTheSameLight)
{
    int const port = free_port();
    write_two_walls(folder / "walls.yaml", port, 2);
    SentHead head(port);
    Mpirun mpirun(2, "",
                  LIGHTWELL_PROGRAM
                  " view cornell --display walls.yaml --set refine=false "
                  "--set play=false --set paths=64 --remote remote --record walk.lwr --stats s.json",
                  folder.path());
    Leader leader(folder / "remote");
    XWindow one("Lightwell: a"), two("Lightwell: b");
    leader.settle();
    for (double const x : {0.62, 0.6}) { // so that surfaces have been drawn
        head.go_to(x);
        std::this_thread::sleep_for(std::chrono::milliseconds(300));
        leader.settle();
    }
    leader.ask({{"do", "set"}, {"key", "rate"}, {"value", 0.2}}); // Hz: the next picture of light waits for 5 s
    leader.settle();
    expect_walls_agree(head, one, two);
    leader.ask({{"do", "quit"}});
    EXPECT_EQ(mpirun.wait(std::chrono::seconds(60)), 0) << mpirun.text();
    auto const stats = nlohmann::json::parse(file_text(folder / "s.json"));
    std::cout << stats["frames_rendered"] << " frames, " << stats["presented"] << " shown, "
              << stats["swap_skew"].get<std::string>() << "\n";
    EXPECT_GT(stats["presented"], stats["frames_rendered"].get<int>() + 5) << "at the display's rate";
}

} // namespace
} // namespace viewer::test
