#include "tests/support/xvfb.h"

#include <csignal>
#include <cstdlib>
#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

extern char** environ;

namespace gi::test {
namespace {

/// The line that the server writes when it is ready; empty = none within the time.
std::string read_line(int from, int timeout_ms)
{
    std::string line;
    pollfd waiting{from, POLLIN, 0};
    while (poll(&waiting, 1, timeout_ms) > 0) {
        char c = 0;
        if (read(from, &c, 1) != 1) return {};
        if (c == '\n') return line;
        line += c;
    }
    return {};
}

} // namespace

Xvfb::Xvfb(int width, int height)
{
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) {
        problem_ = "no pipe";
        return;
    }
    std::string const screen = std::to_string(width) + "x" + std::to_string(height) + "x24";
    char const* const arguments[] = {"Xvfb",         "-displayfd", "3",   "-screen",  "0",
                                     screen.c_str(), "-nolisten",  "tcp", "-noreset", nullptr};
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, ends[1], 3);
    posix_spawn_file_actions_addopen(&actions, 2, "/dev/null", O_WRONLY, 0);
    int const failed =
        posix_spawnp(&server_, "Xvfb", &actions, nullptr, const_cast<char* const*>(arguments), environ);
    posix_spawn_file_actions_destroy(&actions);
    close(ends[1]);
    std::string const number = failed ? "" : read_line(ends[0], 20000);
    close(ends[0]);
    if (failed) {
        server_ = -1;
        problem_ = "there is no Xvfb";
        return;
    }
    if (number.empty()) {
        problem_ = "Xvfb does not start";
        return;
    }
    display_ = ":" + number;
    char const* const before = std::getenv("DISPLAY");
    had_display_ = before != nullptr;
    before_ = before ? before : "";
    setenv("DISPLAY", display_.c_str(), 1);
}

Xvfb::~Xvfb()
{
    if (!display_.empty()) {
        if (had_display_)
            setenv("DISPLAY", before_.c_str(), 1);
        else
            unsetenv("DISPLAY");
    }
    if (server_ <= 0) return;
    kill(server_, SIGTERM);
    waitpid(server_, nullptr, 0);
}

int run_shell(std::string const& command)
{
    int const status = std::system(command.c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

} // namespace gi::test
