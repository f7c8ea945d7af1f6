#pragma once
// One process of a task, which ends with the process that started it.

#include "gi/core/progress.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace viewer::batch {

struct ChildCall {
    std::filesystem::path program;
    std::vector<std::string> arguments;
    std::filesystem::path folder;
    std::filesystem::path standard_output; ///< a file that is replaced, or /dev/null
    double limit_s = 0;                    ///< 0 = unlimited
    std::uint64_t memory_bytes = 0;        ///< 0 = unlimited
};

struct ChildEnd {
    enum class Reason { exited, signalled, too_long, too_much_memory, interrupted };

    Reason reason = Reason::exited;
    int code = 0; ///< exit code, or the signal
    double seconds = 0;
    std::uint64_t memory_bytes = 0; ///< peak of its resident memory
    std::string messages;           ///< the end of its stderr, 4,000 bytes

    bool is_good() const { return reason == Reason::exited && code == 0; }
};

/// Runs a process to its end. What exceeds a limit is killed, with all that it started;
/// after a stop request it gets SIGTERM, and SIGKILL 0.15 s later. Memory is looked at ten times a second.
/// Must be called from the main thread.
/// @throws InputError the program cannot be started
ChildEnd run_child(ChildCall const& call, gi::StopRequest const& stop);

/// "exit code 1", "SIGSEGV (Segmentation fault)", "longer than 10 s", ...
std::string text_of(ChildEnd const& end, ChildCall const& call);

} // namespace viewer::batch
