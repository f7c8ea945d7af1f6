#include "gi/core/progress.h"

#include <gtest/gtest.h>

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

} // namespace
} // namespace gi::test
