#include "gi/core/progress.h"

#include <chrono>
#include <gtest/gtest.h>
#include <thread>

namespace gi::test {
namespace {

TEST(Estimates, AreWordsThatPeopleSay)
{
    EXPECT_EQ(text_of_seconds(0), "0 s");
    EXPECT_EQ(text_of_seconds(59.4), "59 s");
    EXPECT_EQ(text_of_seconds(59.6), "1 min");
    EXPECT_EQ(text_of_seconds(80), "1 min 20 s");
    EXPECT_EQ(text_of_seconds(7500), "2 h 5 min");
    EXPECT_EQ(text_of_seconds(-3), "0 s");
}

TEST(Estimates, AreSaidOnlyOfWhatTakesLong)
{
    testing::internal::CaptureStderr();
    say_estimate("synthesize", 80, "60 pictures");
    say_estimate("synthesize", 2, "1 picture");
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "synthesize: about 1 min 20 s (60 pictures)\n");
}

TEST(BuildStop, EndsWhatWasBegunLongAgoAtOnce)
{
    StopRequest stop;
    BuildStop const begun(&stop);
    std::this_thread::sleep_for(std::chrono::milliseconds(170));
    EXPECT_FALSE(begun.given_up());
    stop.request();
    EXPECT_TRUE(begun.given_up());
}

/// Stages that follow each other have one grace together, not one each.
TEST(BuildStop, LetsNothingGoOnForLong)
{
    StopRequest stop;
    stop.request();
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    EXPECT_TRUE(BuildStop(&stop).given_up());
}

} // namespace
} // namespace gi::test
