#include "gi/base/progress.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <pty.h>
#include <unistd.h>

namespace gi::test {
namespace {

void draw(bool enabled)
{
    ProgressBar bar("render", enabled);
    for (int i = 0; i < 1000; ++i) bar.update(i / 1000.0, "detail");
}

/// What a bar writes to a terminal.
std::string on_a_terminal(bool enabled)
{
    int terminal = 0, program = 0;
    if (openpty(&terminal, &program, nullptr, nullptr, nullptr) != 0) return "no terminal";
    int const kept = dup(STDERR_FILENO);
    dup2(program, STDERR_FILENO);
    draw(enabled);
    fflush(stderr);
    dup2(kept, STDERR_FILENO);
    close(kept);
    close(program);
    fcntl(terminal, F_SETFL, O_NONBLOCK);
    std::string text(4096, '\0');
    auto const n = read(terminal, text.data(), text.size());
    close(terminal);
    text.resize(n > 0 ? std::size_t(n) : 0);
    return text;
}

TEST(ProgressBar, IsSilentWhereThereIsNoTerminal)
{
    testing::internal::CaptureStderr();
    draw(true);
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST(ProgressBar, DrawsAtMostTenTimesASecondAndClearsItself)
{
    std::string const text = on_a_terminal(true);
    if (text == "no terminal") GTEST_SKIP() << "SKIPPED: no pseudo terminal can be opened here";
    EXPECT_NE(text.find("render ["), std::string::npos);
    EXPECT_NE(text.find("detail"), std::string::npos);
    EXPECT_TRUE(text.ends_with("\r\033[K")) << text;
    EXPECT_LT(std::count(text.begin(), text.end(), '\r'), 10);
    EXPECT_EQ(on_a_terminal(false), "");
}

} // namespace
} // namespace gi::test
