#include "viewer/batch/worker_process.h"

#include "gi/core/error.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <fmt/format.h>
#include <sched.h>
#include <string_view>
#include <sys/prctl.h>
#include <unistd.h>

namespace viewer::batch {
namespace {

/// Tasks are no ranks: with these variables they would wait for the other ones.
bool is_of_mpirun(std::string_view variable)
{
    return std::ranges::any_of(std::array{"OMPI_", "PMIX_", "PMI_", "ORTE_", "PRTE_"},
                               [&](char const* start) { return variable.starts_with(start); });
}

} // namespace

WorkerProcess WorkerProcess::start(std::filesystem::path const& program, std::vector<std::string> words,
                                   Share const& share, Lifetime lifetime)
{
    words.insert(words.begin(), program.string());
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    std::string const gpus = fmt::format("CUDA_VISIBLE_DEVICES={}", fmt::join(share.gpus, ","));
    std::vector<char*> environment;
    for (char** e = environ; *e != nullptr; ++e)
        if (!is_of_mpirun(*e) &&
            (share.gpus.empty() || !std::string_view(*e).starts_with("CUDA_VISIBLE_DEVICES=")))
            environment.push_back(*e);
    if (!share.gpus.empty()) environment.push_back(const_cast<char*>(gpus.c_str()));
    environment.push_back(nullptr);
    cpu_set_t cores;
    CPU_ZERO(&cores);
    for (int const core : share.cores) CPU_SET(std::size_t(core), &cores);

    int pipe_ends[2];
    if (::pipe2(pipe_ends, O_CLOEXEC) != 0) throw std::runtime_error(std::strerror(errno));
    pid_t const child = fork();
    if (child == 0) { // system calls only
        setsid();
        if (lifetime == Lifetime::of_starter) prctl(PR_SET_PDEATHSIG, SIGKILL);
        if (!share.cores.empty()) sched_setaffinity(0, sizeof cores, &cores);
        if (pipe_ends[1] == kComputedFd) // dup2 would leave it to be closed by exec
            fcntl(kComputedFd, F_SETFD, 0);
        else
            dup2(pipe_ends[1], kComputedFd);
        execve(program.c_str(), argv.data(), environment.data());
        _exit(127);
    }
    int const error = errno;
    ::close(pipe_ends[1]);
    if (child < 0) {
        ::close(pipe_ends[0]);
        throw gi::InputError("a process cannot be started", std::strerror(error), "run fewer at a time: --cores");
    }
    return {child, pipe_ends[0]};
}

} // namespace viewer::batch
