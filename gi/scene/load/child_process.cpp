#include "gi/scene/load/child_process.h"

#include "gi/core/error.h"
#include "gi/core/step.h"

#include <cerrno>
#include <csignal>
#include <cstdint>
#include <ctime>
#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace gi {
namespace {

constexpr int kStallSeconds = 5, kLooksPerSecond = 20;

std::int64_t processor_time_ns(pid_t process)
{
    clockid_t clock{};
    timespec t{};
    if (clock_getcpuclockid(process, &clock) != 0 || clock_gettime(clock, &t) != 0) return -1;
    return std::int64_t(t.tv_sec) * 1000000000 + t.tv_nsec;
}

} // namespace

ChildProcess::ChildProcess(std::function<void(int pipe)> const& work)
{
    auto const cannot = [](char const* why) {
        return InputError("a file cannot be tested", why, "close other programs");
    };
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) throw cannot("no pipe is available");
    child_ = fork();
    if (child_ == 0) {
        prctl(PR_SET_PDEATHSIG, SIGKILL); // else a stalled child would outlive its parent
        close(ends[0]);
        work(ends[1]);
        _exit(1);
    }
    close(ends[1]);
    pipe_ = ends[0];
    if (child_ > 0) return;
    close(pipe_);
    throw cannot("no process can be started");
}

ChildProcess::~ChildProcess()
{
    if (child_ > 0) {
        kill(child_, SIGKILL);
        status();
    }
    close(pipe_);
}

bool ChildProcess::read(std::string& told)
{
    std::int64_t used_ns = 0;
    for (int idle = 0; idle < kStallSeconds * kLooksPerSecond;) {
        at_step("reading");
        pollfd waiting{pipe_, POLLIN, 0};
        int const ready = poll(&waiting, 1, 1000 / kLooksPerSecond);
        if (ready > 0) {
            char chunk[4096];
            ssize_t const n = ::read(pipe_, chunk, sizeof chunk);
            if (n > 0) told.append(chunk, std::size_t(n));
            if (n >= 0 || errno != EINTR) return n > 0;
        } else if (ready == 0) {
            std::int64_t const now_ns = processor_time_ns(child_);
            idle = now_ns == used_ns ? idle + 1 : 0;
            used_ns = now_ns;
        }
    }
    stalled_ = true;
    kill(child_, SIGKILL);
    return false;
}

std::optional<int> ChildProcess::status()
{
    int status = 0;
    while (waitpid(child_, &status, 0) < 0 && errno == EINTR) {
    }
    child_ = -1;
    return stalled_ ? std::nullopt : std::optional(status);
}

} // namespace gi
