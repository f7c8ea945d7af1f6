#include "viewer/base/standard_streams.h"

#include <csignal>
#include <cstdio>
#include <fcntl.h>
#include <unistd.h>

namespace viewer {
namespace {

bool g_silent = false; // set once, for the whole process

}

void guard_standard_streams()
{
    for (int const fd : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
        if (fcntl(fd, F_GETFD) < 0)
            open("/dev/null", fd == STDIN_FILENO ? O_WRONLY : O_RDONLY); // lowest free = fd
    std::signal(SIGPIPE, SIG_IGN);
}

std::string finish_standard_output()
{
    if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return {};
    bool const is_closed = (fcntl(STDOUT_FILENO, F_GETFL) & O_ACCMODE) == O_RDONLY;
    return is_closed ? "it is closed" : "its reader has ended, or its disk is full";
}

void say(std::string const& text)
{
    if (!g_silent) std::fputs(("note: " + text + "\n").c_str(), stderr);
}

void be_silent() { g_silent = true; }

} // namespace viewer
