#include "viewer/base/frame_range.h"

#include "gi/core/error.h"
#include "viewer/offline/frame_record.h"

#include <gtest/gtest.h>
#include <set>

namespace viewer {
namespace {

TEST(FrameRange, EndsBeforeTheSecondNumber)
{
    FrameRange const r = parse_frame_range("0:120@30");
    EXPECT_EQ(r.first, 0);
    EXPECT_EQ(r.count(), 120);
    EXPECT_EQ(r.time_s(r.end), 4);
    FrameRange const part = parse_frame_range("60:61@24");
    EXPECT_EQ(part.first, 60);
    EXPECT_EQ(part.count(), 1);
}

TEST(FrameRange, TakesSeconds)
{
    FrameRange const r = parse_frame_range("1s:4s@30");
    EXPECT_EQ(r.first, 30);
    EXPECT_EQ(r.end, 120);
    EXPECT_EQ(parse_frame_range("0:0.1s@30").count(), 3) << "0.1 * 30 is not 3 in binary";
}

TEST(FrameRange, TimesDoNotDrift)
{
    FrameRange const r = parse_frame_range("0:100000@30");
    for (int k = r.first; k < r.end; ++k) ASSERT_EQ(r.time_s(k), k / 30.0) << k;
    FrameRange const ntsc = parse_frame_range("0:30001@30000/1001");
    EXPECT_EQ(ntsc.time_s(30000), 1001);
    EXPECT_DOUBLE_EQ(ntsc.fps(), 30000 / 1001.0);
    EXPECT_EQ(parse_frame_range("0:5@0.25").time_s(1), 4);
}

TEST(FrameRange, RefusesNonsense)
{
    for (char const* text : {"",           ":",
                             "0:4",        "@30",
                             "0@30",       "0:4@",
                             ":4@30",      "0:@30",
                             "4:4@30",     "5:4@30",
                             "-1:4@30",    "0:-4@30",
                             "0:4@0",      "0:4@-30",
                             "0:4@nan",    "0:4@inf",
                             "nan:4@30",   "0:inf@30",
                             "0.5:4@30",   "0:4.5@30",
                             "0:0.05s@30", "0:4@1e9",
                             "0:4@1e-9",   "0:1e6@30",
                             "0:1e30@30",  "1e9:1000000004@30",
                             "0:4@30/0",   "0:4@30/",
                             "0:4@/2",     "0:4@30@30",
                             "0:4:2@30",   "0:4m@30",
                             "0:s@30",     " 0:4@30",
                             "0:4@30x",    "@30:0:4"})
        EXPECT_THROW(parse_frame_range(text), gi::InputError) << text;
}

TEST(FrameName, CountsAsPrintfDoes)
{
    EXPECT_EQ(parse_frame_name("--out", "a/f_%04d.exr").of(7), "a/f_0007.exr");
    EXPECT_EQ(parse_frame_name("--out", "f_%04d.exr").of(123456), "f_123456.exr");
    EXPECT_EQ(parse_frame_name("--out", "f%d").of(7), "f7");
    EXPECT_EQ(parse_frame_name("--out", "50%%/f%%_%02d.exr").of(7), "50%/f%_07.exr");
    EXPECT_EQ(parse_frame_name("--out", "f_%03d.exr").of_all(parse_frame_range("0:120@30")), "f_000-119.exr");
}

TEST(FrameName, RefusesOtherPatterns)
{
    for (char const* pattern : {"", "f.exr", "f_%%d.exr", "f_%s.exr", "f_%", "f_%04", "f_%4d.exr", "f_%-4d.exr",
                                "f_%00d.exr", "f_%010d.exr", "%d_%d.exr", "%d/f.exr", "f_%n.exr", "f_%04d%x.exr"})
        EXPECT_THROW(parse_frame_name("--out", pattern), gi::InputError) << pattern;
}

TEST(FrameName, TheExampleIsOfTheOption)
{
    for (auto const& [option, example] :
         {std::pair{"--out", "write f_%04d.exr"}, std::pair{"--png", "write f_%04d.png"}})
        try {
            parse_frame_name(option, "f");
            FAIL();
        } catch (gi::InputError const& e) {
            EXPECT_NE(std::string(e.what()).find(example), std::string::npos) << e.what();
        }
}

TEST(FrameRecords, SecondsOfFramesAsQuantiles)
{
    std::vector<FrameRecord> records(101);
    for (int i = 0; i <= 100; ++i) records[std::size_t(i)].seconds = 100 - i;
    records[0].reused = true;
    nlohmann::ordered_json const seconds = frame_seconds(records); // of 0 to 99 s
    EXPECT_EQ(seconds.at("median"), 49.5);
    EXPECT_NEAR(seconds.at("p95").get<double>(), 94.05, 1e-12);
    EXPECT_NEAR(seconds.at("p99").get<double>(), 98.01, 1e-12);
    EXPECT_EQ(seconds.at("most"), 99);
    EXPECT_TRUE(frame_seconds({records[0]}).is_null()) << "none was rendered";
}

} // namespace
} // namespace viewer
