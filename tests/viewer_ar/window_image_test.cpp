// The session's window under an X server without a monitor.

#include "tests/viewer_show/live_view.h"
#include "tests/viewer_show/x/x_window.h"

#include <sstream>

namespace viewer::test {
namespace {

class ArWindows : public OnScreen {
protected:
    TemporaryFolder folder;
};

TEST_F(ArWindows, ShowTheSessionUntilEscape)
{
    run_well("ar synthesize desk --frames 16 --size 160x120 --paths 1 --no-truth --no-denoise", folder.path());
    // So slow that it does not end by itself meanwhile.
    std::string session = file_text(folder / "desk/session.yaml");
    session.replace(session.find("rate_hz: 30"), 11, "rate_hz: 2");
    std::ofstream(folder / "desk/session.yaml") << session;
    std::istringstream fast(file_text(folder / "desk/poses.csv"));
    std::ofstream slow(folder / "desk/poses.csv");
    for (std::string line; std::getline(fast, line);) {
        std::size_t const end = line.find(',');
        if (line.starts_with("time_s"))
            slow << line << '\n';
        else
            slow << 15 * std::stod(line.substr(0, end)) << line.substr(end) << '\n';
    }
    slow.close();
    Program program(words("ar run desk/session.yaml --window --poses desk/poses.csv --table t.csv"),
                    folder.path());
    XWindow window("Lightwell: augmented", std::chrono::seconds(60));
    if (!window.key_problem().empty()) GTEST_SKIP() << "SKIPPED: " << window.key_problem();
    window.focus();
    sleep_ms(600);
    window.tap("s");
    window.tap("h");
    sleep_ms(100);
    window.tap("Escape");
    Outcome const o = program.wait();
    EXPECT_EQ(o.code, 0) << o.err;
    EXPECT_NE(o.out.find("capture to swap (ms)"), std::string::npos) << o.out;
    std::string const table = file_text(folder / "t.csv");
    EXPECT_LT(std::count(table.begin(), table.end(), '\n'), 17) << "Escape ends it";
}

TEST_F(ArWindows, ShowEachFrameWithItsOwnThings)
{
    // Reads number and ball back from the window's buffer.
    Outcome const o = run("ar bench --counter --window --size 320x240 --frames 12", folder.path());
    EXPECT_EQ(o.code, 0) << o.err << o.out;
}

TEST_F(ArWindows, CompositeOnTheGpu)
{
    run_well("ar synthesize desk --frames 3 --size 160x120 --paths 1 --no-truth --no-denoise", folder.path());
    Outcome const o = run("ar run desk/session.yaml --fast --window --gpu --poses desk/poses.csv", folder.path());
    EXPECT_EQ(o.code, 0) << o.err;
    EXPECT_NE(o.out.find("3 frames, "), std::string::npos) << o.out;
    EXPECT_NE(o.out.find("present (ms)"), std::string::npos) << o.out;
}

} // namespace
} // namespace viewer::test
