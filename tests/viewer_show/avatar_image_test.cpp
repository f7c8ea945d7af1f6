// An avatar in the running viewer: keys raise its hand in the mirror, a recording with it replays bit by bit; and
// who walks there stays on the floor and out of the walls.

#include "gi/image_io/picture_file.h"
#include "tests/support/data.h"
#include "tests/viewer_show/live_view.h"

#include <cmath>

namespace viewer::test {
namespace {

class AvatarView : public OnScreen {
protected:
    /// Mean difference of the picture's middle, where the mirror is.
    static double difference(gi::Picture const& a, gi::Picture const& b)
    {
        std::vector<float> const& p = a.find("color")->data;
        std::vector<float> const& q = b.find("color")->data;
        double sum = 0;
        int count = 0;
        for (int y = a.height / 4; y < 3 * a.height / 4; ++y)
            for (int x = a.width / 3; x < 2 * a.width / 3; ++x, ++count)
                sum += std::abs(double(p[3 * std::size_t(y * a.width + x)] - q[3 * std::size_t(y * a.width + x)]));
        return sum / count;
    }
    static gi::Picture shot(LiveView& view, std::string const& name)
    {
        view.screenshot(name, 0);
        return gi::read_picture(view.folder() / name);
    }
    static void hold(LiveView& view, std::string const& key, bool down)
    {
        view.ask({{"do", "key"}, {"key", key}, {"action", down ? "press" : "release"}});
    }
    static Json position(LiveView& view) { return view.ask({{"do", "camera"}}).at("position"); }

    static void expect_waves(std::string const& avatar)
    {
        LiveView view("mirror --avatar " + avatar + " --size 160x120 --record walk.lwr" + kStill +
                      " --set paths=8");
        view.settle();
        gi::Picture const first = shot(view, "first.png"), second = shot(view, "second.png");
        hold(view, "x", true);
        sleep_ms(900);
        view.settle();
        gi::Picture const raised = shot(view, "raised.png");
        hold(view, "x", false);
        EXPECT_GT(difference(first, raised), 2 * difference(first, second) + 0.002);
        view.quit();
        std::string const told = run_well("view --replay walk.lwr", view.folder().path()).out;
        EXPECT_NE(told.find(" as recorded bit by bit, 0 not, 0 unknown"), std::string::npos) << told;
        run_well("recording export walk.lwr --csv walk.csv", view.folder().path());
    }
};

TEST_F(AvatarView, RaisesItsHandInTheMirrorAndReplays) { expect_waves("avatar"); }

TEST_F(AvatarView, SoDoesAModelOfSomebodyElse)
{
    LIGHTWELL_NEED_DATA("avatars/quaternius_human.glb");
    expect_waves((gi::test::shared_data() / "avatars/quaternius_human.glb").string());
}

TEST_F(AvatarView, WhoWalksStaysOnTheFloorAndOutOfTheMirror)
{
    LiveView view("mirror --navigate walk --eye-height 1.3 --size 80x60" + kStill);
    view.settle();
    EXPECT_EQ(position(view)[1], 1.6) << "until the first step";
    hold(view, "shift", true);
    hold(view, "w", true);
    double const wall_z = -1.58 + 0.25;
    EXPECT_TRUE(is_soon([&] { return std::abs(position(view)[2].get<double>() - wall_z) < 0.02; }));
    sleep_ms(500); // in which it would walk on
    hold(view, "w", false);
    view.settle();
    EXPECT_NEAR(position(view)[1].get<double>(), 1.3, 1e-4);
    EXPECT_NEAR(position(view)[2].get<double>(), wall_z, 0.02);
    view.quit();
}

TEST_F(AvatarView, WhatIsNoAvatarIsRefused)
{
    TemporaryFolder const folder;
    for (char const* call :
         {"view mirror --avatar nowhere.glb", "view mirror --avatar cornell",
          "view --replay a.lwr --avatar avatar", "view mirror --avatar avatar --eye-height 0.25"}) {
        Outcome const o = run(call, folder.path());
        EXPECT_EQ(o.code, 2) << call;
        EXPECT_EQ(std::count(o.err.begin(), o.err.end(), '\n'), 1) << o.err;
    }
}

} // namespace
} // namespace viewer::test
