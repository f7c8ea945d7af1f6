// The state of an interrupted render is saved even if writing its picture fails, and vice versa.

#include "viewer/offline/state_saving.h"

#include "gi/core/error.h"
#include "tests/support/refused_calls.h"

#include <cerrno>
#include <gtest/gtest.h>
#include <stdexcept>
#include <sys/syscall.h>
#include <thread>

namespace viewer::test {
namespace {

constexpr auto kTime = std::chrono::milliseconds(30);

double time_of_states(gi::Report const& report)
{
    for (auto const& [stage, seconds] : report.times())
        if (stage == "checkpoints") return seconds;
    return 0;
}

TEST(StateSaving, GoesOnBesideThePictureAndIsTimed)
{
    auto const here = std::this_thread::get_id();
    std::thread::id there = here;
    gi::RenderResult result;
    result.save_state = [&](gi::DiskWait) {
        std::this_thread::sleep_for(kTime);
        there = std::this_thread::get_id();
    };
    gi::Report report;
    StateSaving saving(result);
    EXPECT_FALSE(result.save_state);
    EXPECT_TRUE(saving.join(report));
    EXPECT_NE(there, here);
    EXPECT_GE(time_of_states(report), 0.03);
    EXPECT_TRUE(report.losses().empty());

    EXPECT_FALSE(StateSaving(result).join(report)) << "there is none any more";
}

TEST(StateSaving, ErrorOfThePictureCostsNoState)
{
    bool is_saved = false;
    gi::RenderResult result;
    result.save_state = [&](gi::DiskWait) {
        std::this_thread::sleep_for(kTime);
        is_saved = true;
    };
    EXPECT_THROW(
        {
            StateSaving const saving(result);
            throw std::bad_alloc();
        },
        std::bad_alloc);
    EXPECT_TRUE(is_saved);
}

TEST(StateSaving, AnyErrorOfTheStateIsReported)
{
    gi::RenderResult result;
    gi::Report report;
    result.save_state = [](gi::DiskWait) { throw gi::InputError("a", "b", "c"); };
    EXPECT_FALSE(StateSaving(result).join(report));
    result.save_state = [](gi::DiskWait) { throw std::runtime_error("d"); };
    EXPECT_FALSE(StateSaving(result).join(report));
    EXPECT_EQ(report.losses().at("checkpoints that could not be written").count, 2u);
}

TEST(StateSaving, NeedsNoThread)
{
    int const code = gi::test::in_child_without({SYS_clone, SYS_clone3}, EAGAIN, [] {
        bool is_saved = false;
        gi::RenderResult result;
        result.save_state = [&](gi::DiskWait) { is_saved = true; };
        gi::Report report;
        try {
            return StateSaving(result).join(report) && is_saved ? 7 : 6;
        } catch (std::exception const&) {
            return 5;
        }
    });
    if (code == gi::test::kNotPermitted) GTEST_SKIP() << "seccomp is not permitted";
    EXPECT_EQ(code, 7);
}

} // namespace
} // namespace viewer::test
