// Work says where it is, to whoever listens on its thread.

#include "gi/core/step.h"

#include "gi/core/progress.h"
#include "gi/core/report.h"

#include <gtest/gtest.h>
#include <thread>
#include <vector>

namespace gi {
namespace {

TEST(Step, IsHeardOnItsThreadOnly)
{
    std::vector<Step> heard;
    at_step("before");
    {
        StepListener const listener([&](Step const& s) { heard.push_back(s); });
        at_step("textures", 3, 24);
        std::thread([] { at_step("elsewhere"); }).join();
        Report report;
        StageTimer const timer(report, "build");
    }
    at_step("after");
    EXPECT_EQ(heard, (std::vector<Step>{{"textures", 3, 24}, {"build", 0, 0}}));
}

TEST(Step, OnlyTheLatestListenerHears)
{
    int outer = 0, inner = 0;
    StepListener const first([&](Step const&) { ++outer; });
    {
        StepListener const second([&](Step const&) { ++inner; });
        at_step("one");
    }
    at_step("two");
    EXPECT_EQ(outer, 1);
    EXPECT_EQ(inner, 1);
}

TEST(Step, ListenersMayEndTheWork)
{
    StepListener const listener([](Step const&) { throw Interrupted(); });
    EXPECT_THROW(at_step("one"), Interrupted);
}

} // namespace
} // namespace gi
