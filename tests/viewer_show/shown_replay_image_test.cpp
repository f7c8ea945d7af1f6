// What a walking user saw is drawn again bit for bit from the recording: surfaces for newer poses, the light of the
// pictures that were there, an avatar, a mirror.

#include "gi/image_io/picture_file.h"
#include "tests/viewer_show/live_view.h"

namespace viewer::test {
namespace {

class ShownReplay : public OnScreen {
protected:
    /// Walks, turns and stands; what the replay said.
    static std::string walk_and_replay(std::string const& arguments, std::string const& replay)
    {
        LiveView view(arguments +
                      " --size 240x160 --record walk.lwr --hash-shown --set panel=false --set refine=false");
        view.settle();
        auto const hold = [&](std::string const& key, char const* action) {
            view.ask({{"do", "key"}, {"key", key}, {"action", action}});
        };
        for (std::string const key : {"w", "d"}) {
            hold(key, "press");
            sleep_ms(1000);
            hold(key, "release");
        }
        sleep_ms(300);
        view.quit();
        std::string const told = run_well("view --replay walk.lwr " + replay, view.folder().path()).out;
        EXPECT_NE(told.find(" 0 not, 0 unknown\n"), std::string::npos) << "as rendered: " << told;
        return told;
    }
    static int drawn_again(std::string const& told)
    {
        std::size_t const at = told.find(" shown pictures drawn again: ");
        if (at == std::string::npos) return 0;
        EXPECT_NE(told.find(" as recorded bit by bit, 0 not, 0 unknown", at), std::string::npos) << told;
        return std::stoi(told.substr(told.rfind('\n', at) + 1));
    }
};

TEST_F(ShownReplay, IsWhatWasShown)
{
    for (char const* arguments : {"cornell", "mirror --avatar avatar"}) {
        SCOPED_TRACE(arguments);
        EXPECT_GE(drawn_again(walk_and_replay(arguments, "--shown")), 5); // a slow machine shows few
    }
}

TEST_F(ShownReplay, WritesItsPictures)
{
    TemporaryFolder const out;
    std::string const told = walk_and_replay("cornell", "--shown --out " + (out / "s_%03d.png").string());
    EXPECT_EQ(int(out.files().size()), drawn_again(told));
    EXPECT_GT(gi::read_picture(out / "s_000.png").width, 0);
}

TEST_F(ShownReplay, IsLeftOutUnlessAskedFor)
{
    std::string const told = walk_and_replay("cornell", "");
    EXPECT_EQ(told.find("shown"), std::string::npos) << told;
}

} // namespace
} // namespace viewer::test
