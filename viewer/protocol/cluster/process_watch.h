#pragma once
// State of another process of this machine, from the system: faster and more reliable than waiting for messages.

#include <cstdint>
#include <string>

namespace viewer {

/// Identifies a process uniquely across machines.
struct ProcessId {
    std::string machine;       ///< boot id and PID namespace
    std::int32_t number = 0;   ///< pid
    std::uint64_t started = 0; ///< clock ticks since boot

    bool operator==(ProcessId const&) const = default;
};

ProcessId this_process();

enum class ProcessState : std::uint8_t {
    unknown, ///< on another machine
    runs,
    stopped, ///< by a signal or a debugger
    ended
};

/// @param here  this_process()
ProcessState state_of(ProcessId const& process, ProcessId const& here);

} // namespace viewer
