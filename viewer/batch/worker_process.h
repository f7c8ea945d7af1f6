#pragma once
// A process `lightwell batch work` as its runner sees it.

#include "viewer/batch/machine.h"

#include <filesystem>
#include <string>
#include <sys/types.h>

namespace viewer::batch {

/// Exit codes of `lightwell batch work`.
enum WorkCode { kWorkDone = 0, kWorkFailed = 1, kWorkTaken = 3, kWorkInterrupted = 130 };

/// Workers that may be killed with one task before it counts as failed: it may be what kills them.
inline constexpr int kMostLost = 10;

/// The worker's end of the pipe on which it tells that its task has computed and its share of the machine is free.
inline constexpr int kComputedFd = 3;

/// Whether a process ends with the one that started it.
enum class Lifetime { own, of_starter };

/// A process in a session of its own: Ctrl-C in a terminal and its end do not reach it.
struct WorkerProcess {
    pid_t pid = -1;
    int pipe = -1; ///< readable: it has computed; closed: it has ended

    /// @param share its processors and GPUs; without any it may use those of this process
    static WorkerProcess start(std::filesystem::path const& program, std::vector<std::string> words,
                               Share const& share, Lifetime lifetime);
};

} // namespace viewer::batch
