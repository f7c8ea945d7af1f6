#include "gi/core/progress.h"

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
    std::string text;
    char part[256];
    // What was written arrives piece by piece; the read after the last of it fails, as nobody can write any more.
    for (ssize_t n; (n = read(terminal, part, sizeof part)) > 0;) text.append(part, std::size_t(n));
    close(terminal);
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
