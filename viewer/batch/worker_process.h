#pragma once
// A process that is forked from this one to run one task, or another program.

#include "viewer/batch/machine.h"

#include <functional>
#include <string>
#include <sys/types.h>
#include <vector>

namespace viewer::batch {

/// Their name in the lists of `ps` and `top`.
inline constexpr char const* kWorkerName = "batch work";

/// A process in a session of its own: Ctrl-C in a terminal and the end of its starter do not reach it.
struct WorkerProcess {
    pid_t pid = -1;
    int pipe = -1; ///< readable: it has sent a message; closed: it has ended

    /// Runs `work` in a copy of this process, which must have no other threads,
    /// without the time that starting a program takes.
    /// @param share its processors and GPUs; without any it may use those of this process
    /// @param work  gets its end of the pipe, returns the exit code;
    /// 2 where it throws an InputError, which is reported
    static WorkerProcess start(Share const& share, std::function<int(int pipe)> const& work);
    /// Runs a program, found by PATH, that ends when this process ends.
    static WorkerProcess start_program(std::vector<std::string> words);
};

} // namespace viewer::batch
