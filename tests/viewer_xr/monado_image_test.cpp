// Sessions with a real runtime.

#include "tests/viewer_xr/monado.h"
#include "tests/viewer_xr/remote_driver.h"

namespace viewer::test {
namespace {

void expect_nothing_lost(nlohmann::json const& r)
{
    for (char const* what : {"discarded", "late_images", "without_pose", "lost_events", "losses", "gl_errors"})
        EXPECT_EQ(r[what], 0) << what;
}

TEST_F(Monado, ShowsFramesWithoutAWindow)
{
    start_service();
    auto const r = run_client("--graphics egl --frames 100");
    EXPECT_EQ(r["shown"], 100) << r;
    EXPECT_EQ(r["phase"], "focused");
    EXPECT_EQ(r["space"], "stage");
    EXPECT_GE(r["pictures"], 100);
    EXPECT_EQ(r["repeated"], 0);
    EXPECT_EQ(r["ended"], "the runtime has ended the session");
    expect_nothing_lost(r);
}

TEST_F(Monado, ShowsThePictureBeforeWhereTheNextIsLate)
{
    start_service();
    auto const r = run_client("--graphics egl --frames 60 --every 7 --log " + (folder / "log.csv").string());
    EXPECT_EQ(r["shown"], 60) << r;
    int const pictures = r["pictures"], repeated = r["repeated"];
    EXPECT_GT(repeated, 5 * pictures);
    EXPECT_GE(pictures, 8);
    expect_nothing_lost(r);
    // Poses continue, and are predicted for times in the future that increase from frame to frame.
    auto const log = read_log(folder / "log.csv");
    ASSERT_GE(log.size(), 60u);
    for (std::size_t i = 1; i < log.size(); ++i) {
        EXPECT_GT(std::stoll(log[i].at("xr_time_ns")), std::stoll(log[i - 1].at("xr_time_ns")));
        EXPECT_NE(log[i].at("head_x"), log[i - 1].at("head_x"));
        double const ahead_s = std::stod(log[i].at("display_s")) - std::stod(log[i].at("pose_s"));
        EXPECT_LT(ahead_s, 0.2);
    }
}

TEST_F(Monado, SaysWhatIsHidden)
{
    start_service();
    auto const r = run_client("--graphics egl --frames 5");
    EXPECT_GT(r["hidden_left"], 0) << r;
    EXPECT_EQ(r["hidden_left"], r["hidden_right"]);
}

TEST_F(Monado, PosesAndViewsComeBackAsTheyWereSet)
{
    int const port = free_port();
    start_service({"--remote", std::to_string(port)});
    RemoteDriver remote(port);
    RemotePose const head{{0, 0.6f, 0, 0.8f}, {0.25f, 1.75f, -0.5f}};
    RemoteEye const left{{-0.9f, 0.7f, 0.8f, -0.6f}, {{0, 0, 0, 1}, {-0.04f, 0, 0}}};
    RemoteEye const right{{-0.7f, 0.9f, 0.75f, -0.65f}, {{0, 0, 0, 1}, {0.04f, 0, 0}}};
    remote.set_head(head);
    remote.set_eyes({left, right});
    remote.set_hand(0, {{0, 0, 0, 1}, {-0.5f, 1.25f, -0.75f}}, {0.5f, -0.25f}, true);
    remote.set_hand(1, {{0, 0, 0, 1}, {0.5f, 1.5f, -0.25f}}, {0, 0}, false);
    remote.send_all();
    Child client(client_call("--graphics egl --frames 40 --log " + (folder / "log.csv").string()), folder.path(),
                 "client");
    EXPECT_EQ(client.wait(Seconds(90)), 0) << client.out() << client.err();
    auto const log = read_log(folder / "log.csv");
    ASSERT_GE(log.size(), 40u);
    for (auto const& row : log) {
        auto const number = [&](std::string const& column) { return std::stof(row.at(column)); };
        for (int i = 0; i < 3; ++i)
            EXPECT_EQ(number(std::string("head_") + "xyz"[i]), head.position[std::size_t(i)]) << "xyz"[i];
        EXPECT_EQ(number("head_qy"), head.rotation[1]);
        EXPECT_EQ(number("head_qw"), head.rotation[3]);
        for (auto const& [side, eye] : {std::pair{"left", left}, {"right", right}})
            for (int i = 0; i < 4; ++i) {
                char const* const edge[] = {"_left", "_right", "_up", "_down"};
                EXPECT_EQ(number(std::string(side) + edge[i]), eye.fov_rad[std::size_t(i)]) << side << edge[i];
            }
        // 0.04 m to either side of a head that is turned by 2 asin(0.6): cos = 0.28, sin = 0.96
        EXPECT_NEAR(number("left_x"), 0.25f - 0.04f * 0.28f, 1e-6f);
        EXPECT_NEAR(number("left_z"), -0.5f + 0.04f * 0.96f, 1e-6f);
        EXPECT_NEAR(number("right_x"), 0.25f + 0.04f * 0.28f, 1e-6f);
        EXPECT_NEAR(number("right_z"), -0.5f - 0.04f * 0.96f, 1e-6f);
        EXPECT_EQ(number("left_y"), 1.75f);
    }
    auto const& last = log.back();
    EXPECT_EQ(last.at("profile_left"), "/interaction_profiles/valve/index_controller");
    EXPECT_EQ(last.at("select_left"), "1");
    EXPECT_EQ(std::stof(last.at("move_left_x")), 0.5f);
    EXPECT_EQ(std::stof(last.at("move_left_y")), -0.25f);
    EXPECT_EQ(std::stof(last.at("hand_left_x")), -0.5f);
    EXPECT_EQ(std::stof(last.at("hand_right_y")), 1.5f);
    EXPECT_NE(last.at("aim_left_x"), "");
}

TEST_F(Monado, RecentreBringsTheHeadToTheMiddle)
{
    int const port = free_port();
    start_service({"--remote", std::to_string(port)});
    RemoteDriver remote(port);
    remote.set_head({{0, 0.6f, 0, 0.8f}, {0.25f, 1.75f, -0.5f}});
    remote.send_all();
    auto const r = run_client("--graphics egl --frames 40 --recentre --log " + (folder / "log.csv").string());
    expect_nothing_lost(r);
    auto const log = read_log(folder / "log.csv");
    ASSERT_GE(log.size(), 40u);
    auto const number = [&](char const* column) { return std::stod(log.back().at(column)); };
    EXPECT_NEAR(number("head_x"), 0, 1e-6);
    EXPECT_NEAR(number("head_z"), 0, 1e-6);
    EXPECT_NEAR(number("head_y"), 1.75, 1e-6);
    EXPECT_NEAR(number("head_qy"), 0, 1e-6);
    EXPECT_EQ(std::stof(log.back().at("left_y")), 1.75f) << "raw poses stay those of the runtime";
    EXPECT_NEAR(number("left_z"), -0.5, 0.05);
}

TEST_F(Monado, SeatedUsersHaveTheHeightThatWasStated)
{
    int const port = free_port();
    start_service({"--remote", std::to_string(port)});
    RemoteDriver remote(port);
    remote.set_head({{0, 0, 0, 1}, {0.25f, 1.75f, -0.5f}});
    remote.send_all();
    auto const r = run_client("--graphics none --frames 20 --seated --log " + (folder / "log.csv").string());
    EXPECT_EQ(r["space"], "local, eyes 1.2 m above the floor");
    // Monado's local space begins 1.6 m above its stage.
    EXPECT_NEAR(std::stod(read_log(folder / "log.csv").back().at("head_y")), 1.75 - 1.6 + 1.2, 1e-6);
}

/// The user recentres with the runtime's own means, as by a button of the headset.
TEST_F(Monado, RuntimeMayRecentre)
{
    int const port = free_port();
    start_service({"--remote", std::to_string(port)});
    RemoteDriver remote(port);
    remote.set_head({{0, 0.6f, 0, 0.8f}, {0.25f, 1.75f, -0.5f}});
    remote.send_all();
    Child client(
        client_call("--graphics egl --frames 80 --every 1000 --seated --log " + (folder / "log.csv").string()),
        folder.path(), "client");
    ASSERT_TRUE(wait_for([&] { return client.out().find("counting") != std::string::npos; }, Seconds(30)))
        << client.out() << client.err();
    Child control({kScript, "client", "--dir", runtime_folder(), "--", control_program(), "-c"}, folder.path(),
                  "ctl");
    EXPECT_EQ(control.wait(Seconds(10)), 0) << control.out() << control.err();
    EXPECT_EQ(client.wait(Seconds(60)), 0) << client.out() << client.err();
    auto const r = result(client.out());
    EXPECT_EQ(r["moved_spaces"], 1) << r;
    expect_nothing_lost(r);
    auto const log = read_log(folder / "log.csv");
    auto const number = [&](char const* column) { return std::stod(log.back().at(column)); };
    EXPECT_NEAR(std::stod(log.front().at("head_x")), 0.25, 1e-6);
    EXPECT_NEAR(number("head_x"), 0, 1e-6);
    EXPECT_NEAR(number("head_z"), 0, 1e-6);
    EXPECT_NEAR(number("head_qy"), 0, 1e-6);
    EXPECT_NEAR(number("head_y"), 1.75 - 1.6 + 1.2, 1e-6) << "Monado keeps the height";
}

TEST_F(Monado, TracksHeadAndHandsWithoutPictures)
{
    start_service({"--controllers"});
    auto const r = run_client("--graphics none --frames 100 --log " + (folder / "log.csv").string());
    EXPECT_EQ(r["shown"], 100) << r;
    expect_nothing_lost(r);
    auto const log = read_log(folder / "log.csv");
    ASSERT_GE(log.size(), 100u);
    auto const& last = log.back();
    EXPECT_NE(last.at("head_x"), log.front().at("head_x"));
    EXPECT_EQ(last.at("profile_left"), "/interaction_profiles/khr/simple_controller");
    for (char const* column : {"hand_left_x", "hand_right_x", "aim_left_x"})
        EXPECT_NE(last.at(column), "") << column;
    EXPECT_LT(std::stod(last.at("hand_left_x")), std::stod(last.at("hand_right_x")));
}

class EachUse : public Monado, public ::testing::WithParamInterface<char const*> {};

INSTANTIATE_TEST_SUITE_P(Uses, EachUse, ::testing::Values("egl", "none"),
                         [](auto const& use) { return std::string(use.param); });

TEST_P(EachUse, LossIsNamedAndAnotherSessionFollows)
{
    start_service();
    Child client(client_call(std::string("--keep --frames 30 --graphics ") + GetParam()), folder.path(), "client");
    ASSERT_TRUE(wait_for([&] { return client.out().find("focused") != std::string::npos; }, Seconds(30)))
        << client.out() << client.err();
    std::this_thread::sleep_for(Seconds(1));
    service->stop_at_once();
    ASSERT_TRUE(wait_for([&] { return client.out().find("lost: xr") != std::string::npos; }, Seconds(20)))
        << client.out() << client.err();
    std::this_thread::sleep_for(Seconds(2)); // attempts that fail
    start_service();
    EXPECT_EQ(client.wait(Seconds(60)), 0) << client.out() << client.err();
    auto const r = result(client.out());
    EXPECT_EQ(r["losses"], 1) << r;
    EXPECT_EQ(r["shown"], 30) << r;
    EXPECT_NE(client.out().find("XR_ERROR_"), std::string::npos) << client.out();
    std::puts(client.out().c_str());
}

} // namespace
} // namespace viewer::test
