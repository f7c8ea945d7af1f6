// What a walking user saw is drawn again bit for bit from the recording: surfaces for newer poses, the light of the
// pictures that were there, an avatar, a mirror.

#include "gi/image_io/picture_file.h"
#include "tests/viewer_show/live_view.h"

#include <fstream>
#include <set>

namespace viewer::test {
namespace {

class ShownReplay : public OnScreen {
protected:
    /// Walks, turns and stands; what the replay said.
    static std::string walk_and_replay(std::string const& arguments, std::string const& replay)
    {
        bool const has_display = arguments.find("--display") != std::string::npos;
        LiveView view(arguments + (has_display ? "" : " --size 240x160") +
                      " --record walk.lwr --hash-shown --set panel=false --set refine=false");
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

/// Each window draws with a renderer of its own, to which the others' light is unknown.
TEST_F(ShownReplay, IsWhatTwoEyesAndSeveralWindowsShowed)
{
    TemporaryFolder const folder;
    std::ofstream(folder / "corner.yaml") << R"(name: corner
walls:
  - {name: left, lower_left_m: [-1, 0, 1], lower_right_m: [-1, 0, -1], upper_left_m: [-1, 2, 1], window: left}
  - {name: front, lower_left_m: [-1, 0, -1], lower_right_m: [1, 0, -1], upper_left_m: [-1, 2, -1], window: front, stereo: side-by-side}
windows:
  - {name: left, size_px: [120, 120], position_px: [0, 0]}
  - {name: front, size_px: [240, 120], position_px: [140, 0]}
users:
  - {name: guest, head_position_m: [0, 1, 0]}
)";
    for (std::string const& arguments : {std::string("cornell --set stereo=side-by-side"),
                                         "cornell --display " + (folder / "corner.yaml").string()}) {
        SCOPED_TRACE(arguments);
        EXPECT_GE(drawn_again(walk_and_replay(arguments, "--shown")), 5);
    }
}

TEST_F(ShownReplay, WritesItsPictures)
{
    TemporaryFolder const out;
    std::string const told = walk_and_replay("cornell", "--shown --out " + (out / "s_%03d.png").string());
    EXPECT_EQ(int(out.files().size()), drawn_again(told));
    EXPECT_GT(gi::read_picture(out / "s_000.png").width, 0);
}

/// What a screenshot showed is among the pictures drawn again, in each stereo mode, and all have the window's size.
TEST_F(ShownReplay, WritesWhatTheWindowShowed)
{
    for (std::string const mode : {"off", "side-by-side", "anaglyph-dubois"}) {
        SCOPED_TRACE(mode);
        LiveView view(
            "cornell --size 200x120 --record walk.lwr --set panel=false --set refine=false --set stereo=" + mode);
        view.settle();
        view.ask({{"do", "key"}, {"key", "w"}, {"action", "press"}});
        sleep_ms(700);
        view.ask({{"do", "key"}, {"key", "w"}, {"action", "release"}});
        view.screenshot("window.png");
        view.quit();
        TemporaryFolder const& folder = view.folder();
        std::vector<float> const window = gi::read_picture(folder / "window.png").find("color")->data;
        run_well("view --replay walk.lwr --shown --out s_%03d.png", folder.path());
        bool found = false;
        std::set<int> widths;
        for (std::string const& name : folder.files()) {
            if (!name.starts_with("s_")) continue;
            gi::Picture const p = gi::read_picture(folder / name);
            widths.insert(p.width);
            found |= p.find("color")->data == window;
        }
        EXPECT_EQ(widths, std::set<int>{200});
        EXPECT_TRUE(found);
        run_well("view --replay walk.lwr --shown --size 100x60 --out t_%03d.png", folder.path());
        for (std::string const& name : folder.files()) {
            if (!name.starts_with("t_")) continue;
            gi::Picture const p = gi::read_picture(folder / name);
            ASSERT_EQ(glm::ivec2(p.width, p.height), glm::ivec2(100, 60)) << name;
        }
    }
}

TEST_F(ShownReplay, IsLeftOutUnlessAskedFor)
{
    std::string const told = walk_and_replay("cornell", "");
    EXPECT_EQ(told.find("shown"), std::string::npos) << told;
}

} // namespace
} // namespace viewer::test
