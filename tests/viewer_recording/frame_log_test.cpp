#include "gi/core/error.h"
#include "tests/viewer/run_program.h"
#include "tests/viewer_recording/walk.h"
#include "viewer/protocol/recording/frame_log.h"
#include "viewer/protocol/recording/frame_summary.h"

namespace viewer::test {
namespace {

FrameTimes times_at(std::uint64_t n, double swap_s)
{
    FrameTimes t;
    t.frame = n;
    t.swap_s = swap_s;
    return t;
}

TEST(FrameSummary, OfKnownIntervals)
{
    FrameStatistics s;
    double at_s = 5;
    s.add(times_at(0, at_s));
    for (int i = 1; i <= 1000; ++i) s.add(times_at(std::uint64_t(i), at_s += i * 1e-4)); // 0.1 to 100 ms
    FrameTimes last = times_at(1001, at_s += 0.25);
    last.dropped = 14;
    last.reprojected = true;
    s.add(last);
    FrameSummary const sum = s.summary();
    EXPECT_EQ(sum.frames, 1002u);
    EXPECT_NEAR(sum.mean_ms, (50050 + 250) / 1001.0, 1e-6);
    EXPECT_NEAR(sum.p50_ms, 50, 0.0035 * 50);
    EXPECT_NEAR(sum.p95_ms, 95, 0.0035 * 95);
    EXPECT_NEAR(sum.p99_ms, 99, 0.0035 * 99);
    EXPECT_NEAR(sum.max_ms, 250, 1e-6);
    EXPECT_EQ(sum.dropped, 14u);
    EXPECT_EQ(sum.reprojected, 1u);
    EXPECT_EQ(to_json(sum)["dropped"], 14);
}

TEST(FrameSummary, OfNothingAndOfExtremes)
{
    FrameStatistics s;
    EXPECT_EQ(s.summary().max_ms, 0);
    s.add(times_at(0, 1));
    EXPECT_EQ(s.summary().p99_ms, 0);
    s.add(times_at(1, 0)); // a clock that went back counts as no time
    s.add(times_at(2, 1e9));
    EXPECT_EQ(s.summary().max_ms, 1e12);
    EXPECT_GT(s.summary().p99_ms, 9e4);
}

TEST(FrameLog, IsATableWithItsUnits)
{
    TemporaryFolder const folder;
    gi::Report report;
    FrameLog log(folder / "frames.csv", "lightwell 0.1.0\nlightwell view atrium", report);
    FrameTimes t = *walk_frame(4).times;
    t.tracker_ms = 12.5;
    t.late_ms = -0.125;
    log.append(t);
    t = {};
    t.frame = 5;
    log.append(t);
    log.close();
    std::string const text = text_of(folder / "frames.csv");
    EXPECT_TRUE(text.starts_with("# lightwell 0.1.0\n# lightwell view atrium\n# frame: ")) << text;
    EXPECT_NE(text.find("\nframe,pose_s,display_s,swap_s,swap_method,"), std::string::npos);
    EXPECT_NE(text.find(",fence,0,0,0,11.25,0,0,3.5,1,0,0,0,-0.125,0,12.5\n"), std::string::npos) << text;
    EXPECT_TRUE(text.ends_with("5,0,0,0,none,0,0,0,0,0,0,,1,0,0,0,0,0,\n")) << text;
    std::string const names = text.substr(text.find("\nframe,") + 1);
    auto const commas = [](std::string const& line) { return std::count(line.begin(), line.end(), ','); };
    std::istringstream lines(names);
    for (std::string line; std::getline(lines, line);) EXPECT_EQ(commas(line), 18) << line;
    EXPECT_THROW(FrameLog(folder / "frames.csv", "", report), gi::InputError);
    EXPECT_EQ(text_of(folder / "frames.csv"), text);
}

} // namespace
} // namespace viewer::test
