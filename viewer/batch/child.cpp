#include "viewer/batch/child.h"

#include "gi/core/error.h"

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <fmt/format.h>
#include <fstream>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

namespace viewer::batch {
namespace {

using Clock = std::chrono::steady_clock;

constexpr auto kGrace = std::chrono::milliseconds(150), kLook = std::chrono::milliseconds(100);
constexpr std::size_t kMostMessages = 4000, kPipeBytes = 65536;

/// Between vfork and exec: system calls only. @return if it fails: errno
int become(ChildCall const& call, char* const* argv, pid_t parent, int messages)
{
    setpgid(0, 0);
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != parent) return ECHILD; // it died before that
    for (int const s : {SIGINT, SIGTERM, SIGPIPE}) signal(s, SIG_DFL);
    int const in = open("/dev/null", O_RDONLY | O_CLOEXEC);
    int const out = open(call.standard_output.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (in >= 0 && out >= 0 && dup2(in, 0) == 0 && dup2(out, 1) == 1 && dup2(messages, 2) == 2 &&
        chdir(call.folder.c_str()) == 0)
        execv(call.program.c_str(), argv);
    return errno;
}

/// Reads a pipe as it comes and keeps the end of the text.
class Messages {
public:
    explicit Messages(int pipe) : pipe_(pipe) {}
    ~Messages() { ::close(pipe_); }
    Messages(Messages const&) = delete;
    Messages& operator=(Messages const&) = delete;

    int pipe() const { return is_open_ ? pipe_ : -1; }
    /// @return false if there is nothing now
    bool read()
    {
        char part[kMostMessages];
        ssize_t const n = ::read(pipe_, part, sizeof part);
        if (n == 0) is_open_ = false;
        if (n <= 0) return false;
        text_.append(part, std::size_t(n));
        if (text_.size() <= kMostMessages) return true;
        text_.erase(0, text_.size() - kMostMessages);
        is_cut_ = true;
        return true;
    }
    std::string text() const { return (is_cut_ ? "..." : "") + text_; }

private:
    int pipe_;
    bool is_open_ = true, is_cut_ = false;
    std::string text_;
};

std::uint64_t resident_bytes(pid_t process)
{
    std::ifstream in(fmt::format("/proc/{}/statm", process));
    std::uint64_t size = 0, resident = 0;
    in >> size >> resident;
    return resident * std::uint64_t(sysconf(_SC_PAGESIZE));
}

/// Waits until the process ends or `until`, and reads what it says.
bool ends_before(int process_fd, Clock::time_point until, Messages& messages)
{
    for (;;) {
        auto const left = std::chrono::ceil<std::chrono::milliseconds>(until - Clock::now()).count();
        pollfd p[]{{process_fd, POLLIN, 0}, {messages.pipe(), POLLIN, 0}};
        if (::poll(p, 2, int(std::max<long long>(0, left))) <= 0) return false;
        if (p[1].revents != 0) messages.read();
        if (p[0].revents != 0) return true;
        if (left <= 0) return false;
    }
}

struct StartedChild {
    pid_t process;
    int fd; ///< readable at its end
};

gi::InputError cannot_start(ChildCall const& call, int error)
{
    return {"'" + call.program.string() + "' cannot be started", std::strerror(error),
            "check the programs and the store"};
}

/// @param messages is closed
StartedChild start(ChildCall const& call, int messages)
{
    std::vector<std::string> words{call.program.string()};
    words.insert(words.end(), call.arguments.begin(), call.arguments.end());
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    int volatile error = 0; // vfork: the child has this process's memory until it becomes the program
    pid_t const parent = getpid(), child = vfork();
    if (child == 0) {
        error = become(call, argv.data(), parent, messages);
        _exit(127);
    }
    if (child < 0) error = errno;
    ::close(messages);
    // Debian 12's function is for C only.
    int const fd = error == 0 ? int(::syscall(SYS_pidfd_open, child, 0)) : -1;
    if (fd >= 0) return {child, fd};
    if (error == 0) error = errno;
    if (child > 0) {
        kill(-child, SIGKILL);
        ::waitpid(child, nullptr, 0);
    }
    throw cannot_start(call, error);
}

} // namespace

ChildEnd run_child(ChildCall const& call, gi::StopRequest const& stop)
{
    auto const begin = Clock::now();
    int pipe_ends[2];
    if (::pipe2(pipe_ends, O_CLOEXEC) != 0) throw cannot_start(call, errno);
    ::fcntl(pipe_ends[0], F_SETFL, O_NONBLOCK);
    Messages messages(pipe_ends[0]);
    StartedChild const started = start(call, pipe_ends[1]);
    pid_t const child = started.process;
    int const process_fd = started.fd;
    ChildEnd end;
    using Reason = ChildEnd::Reason;
    auto const limit =
        call.limit_s > 0
            ? begin + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(call.limit_s))
            : Clock::time_point::max();
    while (!ends_before(process_fd, std::min(limit, Clock::now() + kLook), messages)) {
        if (stop.requested()) {
            end.reason = Reason::interrupted;
            kill(-child, SIGTERM);
            if (!ends_before(process_fd, Clock::now() + kGrace, messages)) kill(-child, SIGKILL);
        } else if (Clock::now() >= limit) {
            end.reason = Reason::too_long;
            kill(-child, SIGKILL);
        } else if (call.memory_bytes > 0 && resident_bytes(child) > call.memory_bytes) {
            end.reason = Reason::too_much_memory;
            kill(-child, SIGKILL);
        }
    }
    ::close(process_fd);
    kill(-child, SIGKILL); // what it left running; not yet waited for, so its number is no other's
    int status = 0;
    rusage usage{};
    while (::wait4(child, &status, 0, &usage) < 0 && errno == EINTR) {
    }
    for (std::size_t k = 0; k <= kPipeBytes / kMostMessages && messages.read();) ++k; // what a pipe holds
    end.messages = messages.text();
    end.seconds = std::chrono::duration<double>(Clock::now() - begin).count();
    end.memory_bytes = std::uint64_t(usage.ru_maxrss) * 1024;
    end.code = WIFEXITED(status) ? WEXITSTATUS(status) : WTERMSIG(status);
    if (end.reason == Reason::exited && WIFSIGNALED(status)) end.reason = Reason::signalled;
    return end;
}

std::string text_of(ChildEnd const& end, ChildCall const& call)
{
    switch (end.reason) {
    case ChildEnd::Reason::exited:
        return fmt::format("exit code {}", end.code);
    case ChildEnd::Reason::signalled:
        return fmt::format("SIG{} ({})", sigabbrev_np(end.code) != nullptr ? sigabbrev_np(end.code) : "?",
                           sigdescr_np(end.code) != nullptr ? sigdescr_np(end.code) : "unknown");
    case ChildEnd::Reason::too_long:
        return fmt::format("longer than {} s", call.limit_s);
    case ChildEnd::Reason::too_much_memory:
        return fmt::format("more than {:.0f} MB of memory", double(call.memory_bytes) * 1e-6);
    case ChildEnd::Reason::interrupted:
        break;
    }
    return "interrupted";
}

} // namespace viewer::batch
