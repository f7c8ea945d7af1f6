// The state of an interrupted render is saved, whatever becomes of its picture, and the other way round.

#include "viewer/offline/state_saving.h"

#include "gi/core/error.h"

#include <cerrno>
#include <cstddef>
#include <gtest/gtest.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <stdexcept>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

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
    result.save_state = [&] {
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
    result.save_state = [&] {
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
    result.save_state = [] { throw gi::InputError("a", "b", "c"); };
    EXPECT_FALSE(StateSaving(result).join(report));
    result.save_state = [] { throw std::runtime_error("d"); };
    EXPECT_FALSE(StateSaving(result).join(report));
    EXPECT_EQ(report.losses().at("checkpoints that could not be written").count, 2u);
}

/// From now on no thread can be started in this process.
bool refuse_threads()
{
    sock_filter code[]{BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, nr)),
                       BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, SYS_clone, 1, 0),
                       BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, SYS_clone3, 0, 1),
                       BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ERRNO | EAGAIN),
                       BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW)};
    sock_fprog const program{std::size(code), code};
    return prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 &&
           prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program) == 0;
}

TEST(StateSaving, NeedsNoThread)
{
    pid_t const child = fork(); // the refusal stays
    if (child == 0) {
        if (!refuse_threads()) _exit(8);
        bool is_saved = false;
        gi::RenderResult result;
        result.save_state = [&] { is_saved = true; };
        gi::Report report;
        try {
            _exit(StateSaving(result).join(report) && is_saved ? 7 : 6);
        } catch (std::exception const&) {
            _exit(5);
        }
    }
    int status = 0;
    waitpid(child, &status, 0);
    ASSERT_TRUE(WIFEXITED(status));
    if (WEXITSTATUS(status) == 8) GTEST_SKIP() << "seccomp is not permitted";
    EXPECT_EQ(WEXITSTATUS(status), 7);
}

} // namespace
} // namespace viewer::test
