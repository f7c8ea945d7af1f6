#include "gi/scene/load/child_process.h"

#include "gi/core/error.h"
#include "gi/core/step.h"

#include <cerrno>
#include <csignal>
#include <cstdint>
#include <ctime>
#include <exception>
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

/// Reads until the other end of the pipe is closed (true) or the process stalls (false).
bool read_all(int pipe, pid_t process, std::string& told)
{
    std::int64_t used_ns = 0;
    for (int idle = 0; idle < kStallSeconds * kLooksPerSecond;) {
        at_step("reading");
        pollfd waiting{pipe, POLLIN, 0};
        int const ready = poll(&waiting, 1, 1000 / kLooksPerSecond);
        if (ready > 0) {
            char chunk[4096];
            ssize_t const n = read(pipe, chunk, sizeof chunk);
            if (n > 0) told.append(chunk, std::size_t(n));
            if (n == 0 || (n < 0 && errno != EINTR)) return true;
        } else if (ready == 0) {
            std::int64_t const now_ns = processor_time_ns(process);
            idle = now_ns == used_ns ? idle + 1 : 0;
            used_ns = now_ns;
        }
    }
    return false;
}

} // namespace

std::optional<int> run_child(std::function<void(int pipe)> const& work, std::string& told)
{
    int ends[2];
    if (pipe(ends) != 0)
        throw InputError("a file cannot be tested", "no pipe is available", "close other programs");
    pid_t const child = fork();
    if (child == 0) {
        prctl(PR_SET_PDEATHSIG, SIGKILL); // else a stalled child would outlive its parent
        close(ends[0]);
        work(ends[1]);
        _exit(1);
    }
    close(ends[1]);
    bool ended = child < 0;
    std::exception_ptr abandoned;
    try {
        ended = ended || read_all(ends[0], child, told);
    } catch (...) { // by a listener of steps
        abandoned = std::current_exception();
    }
    close(ends[0]);
    if (child < 0)
        throw InputError("a file cannot be tested", "no process can be started", "close other programs");
    if (!ended) kill(child, SIGKILL);
    int status = 0;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    if (abandoned) std::rethrow_exception(abandoned);
    return ended ? std::optional(status) : std::nullopt;
}

} // namespace gi
