// Recorded poses.

#include "gi/core/error.h"
#include "viewer/devices/tracking/known_walk.h"
#include "viewer/devices/tracking/tracker_file.h"

#include <gtest/gtest.h>

namespace viewer::test {
namespace {

constexpr char kHeader[] = "time_s,body,x_m,y_m,z_m,qx,qy,qz,qw\n";

TEST(TrackerFile, WritesWhatItReads)
{
    auto const walk = known_walk_samples(1, 30);
    auto const again = parse_tracker_file(format_tracker_file(walk), "walk.csv");
    ASSERT_EQ(again.size(), walk.size());
    for (std::size_t i = 0; i < walk.size(); ++i) {
        EXPECT_EQ(again[i].body, walk[i].body);
        EXPECT_EQ(again[i].measured_s, walk[i].measured_s);
        EXPECT_EQ(again[i].pose.position, walk[i].pose.position);
        EXPECT_NEAR(again[i].pose.rotation.w, walk[i].pose.rotation.w, 1e-15);
    }
}

TEST(TrackerFile, ErrorsHaveTheirPlace)
{
    auto const message = [](std::string const& text) -> std::string {
        try {
            parse_tracker_file(text, "a.csv");
            return "no error";
        } catch (gi::InputError const& e) {
            return e.what();
        }
    };
    std::string const h = kHeader;
    EXPECT_NE(message("").find("no poses"), std::string::npos);
    EXPECT_NE(message("time,body\n").find("a.csv:1:1"), std::string::npos);
    EXPECT_NE(message("time_s,body,x_m\n").find("a.csv:1"), std::string::npos);
    EXPECT_NE(message(h + "0,head,0,x,0,0,0,0,1\n").find("a.csv:2:10"), std::string::npos)
        << message(h + "0,head,0,x,0,0,0,0,1\n");
    EXPECT_NE(message(h + "# fine\n\n0,head,0,0,0,0,0,0\n").find("a.csv:4"), std::string::npos);
    EXPECT_NE(message(h + "0,head,0,0,0,0,0,0,0\n").find("quaternion"), std::string::npos);
    EXPECT_NE(message(h + "1,head,0,0,0,0,0,0,1\n0,head,0,0,0,0,0,0,1\n").find("a.csv:3"), std::string::npos);
    EXPECT_NE(message(h + "0,,0,0,0,0,0,0,1\n").find("no name"), std::string::npos);
    EXPECT_EQ(message(h + " 0 , head , 0,0,0, 0,0,0,1 \r\n"), "no error");
    EXPECT_THROW(read_tracker_file("/nowhere/walk.csv"), gi::InputError);
}

TEST(TrackerFile, PlaysAtTheClocksPace)
{
    FileTracker tracker(known_walk_samples(1, 10), "walk"); // 11 moments of 3 bodies
    std::vector<TrackerSample> got;
    tracker.poll(100, got);
    EXPECT_EQ(got.size(), 3u);
    tracker.poll(100.45, got);
    EXPECT_EQ(got.size(), 15u);
    EXPECT_NEAR(got.back().received_s, 100.4, 1e-9);
    tracker.poll(200, got);
    EXPECT_EQ(got.size(), 33u);
    EXPECT_TRUE(tracker.at_end());

    FileTracker fast(known_walk_samples(1, 10), "walk", AtEnd::begin_again, 2);
    got.clear();
    fast.poll(0, got);
    fast.poll(10, got);
    double const rounds = 10 / (33 / 32.0 * 0.5);
    EXPECT_NEAR(double(got.size()), rounds * 33, 35);
    for (std::size_t i = 1; i < got.size(); ++i) EXPECT_GE(got[i].received_s, got[i - 1].received_s);
}

} // namespace
} // namespace viewer::test
