#include "viewer/batch/worker_process.h"

#include "gi/core/error.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <fcntl.h>
#include <fmt/format.h>
#include <sched.h>
#include <string_view>
#include <sys/prctl.h>
#include <unistd.h>

namespace viewer::batch {
namespace {

void bind(Share const& share)
{
    if (!share.gpus.empty())
        setenv("CUDA_VISIBLE_DEVICES", fmt::format("{}", fmt::join(share.gpus, ",")).c_str(), 1);
    if (share.cores.empty()) return;
    cpu_set_t cores;
    CPU_ZERO(&cores);
    for (int const core : share.cores) CPU_SET(std::size_t(core), &cores);
    sched_setaffinity(0, sizeof cores, &cores);
}

int run(std::function<int(int)> const& work, int pipe)
try {
    return work(pipe);
} catch (gi::InputError const& e) {
    std::fputs(fmt::format("lightwell: {}\n", e.what()).c_str(), stderr);
    return 2;
} catch (std::exception const& e) {
    std::fputs(fmt::format("lightwell: internal error: {}\n", e.what()).c_str(), stderr);
    return 2;
}

bool is_of_mpirun(std::string_view variable)
{
    return std::ranges::any_of(std::array{"OMPI_", "PMIX_", "PMI_", "ORTE_", "PRTE_"},
                               [&](char const* start) { return variable.starts_with(start); });
}

/// Tasks are no ranks: with these variables they would wait for the other ones.
void leave_mpirun()
{
    std::vector<std::string> names;
    for (char** e = environ; *e != nullptr; ++e)
        if (is_of_mpirun(*e)) names.emplace_back(std::string_view(*e).substr(0, std::string_view(*e).find('=')));
    for (std::string const& name : names) unsetenv(name.c_str());
}

} // namespace

WorkerProcess WorkerProcess::start(Share const& share, std::function<int(int)> const& work)
{
    int pipe_ends[2];
    if (::pipe2(pipe_ends, O_CLOEXEC) != 0) throw std::runtime_error(std::strerror(errno));
    pid_t const child = fork();
    if (child == 0) {
        setsid();
        prctl(PR_SET_NAME, kWorkerName);
        std::signal(SIGPIPE, SIG_IGN); // its starter may be killed
        leave_mpirun();
        bind(share);
        _exit(run(work, pipe_ends[1])); // nothing of its starter is closed, flushed or removed
    }
    int const error = errno;
    ::close(pipe_ends[1]);
    if (child < 0) {
        ::close(pipe_ends[0]);
        throw gi::InputError("a process cannot be started", std::strerror(error), "run fewer at a time: --cores");
    }
    return {child, pipe_ends[0]};
}

WorkerProcess WorkerProcess::start_program(std::vector<std::string> words)
{
    return start({}, [&](int own_end) {
        prctl(PR_SET_PDEATHSIG, SIGKILL);
        fcntl(own_end, F_SETFD, 0); // closed at its end
        std::vector<char*> argv;
        for (std::string& word : words) argv.push_back(word.data());
        argv.push_back(nullptr);
        execvp(argv[0], argv.data());
        return 127;
    });
}

} // namespace viewer::batch
