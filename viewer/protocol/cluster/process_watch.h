#pragma once
// What the system says of another process of this machine: quicker, and surer, than waiting for its messages.

#include <cstdint>
#include <string>

namespace viewer {

/// Tells a process from all others, on any machine.
struct ProcessId {
    std::string machine;       ///< its boot and the name space of its process numbers
    std::int32_t number = 0;   ///< pid
    std::uint64_t started = 0; ///< clock ticks since boot

    bool operator==(ProcessId const&) const = default;
};

ProcessId this_process();

enum class ProcessState : std::uint8_t {
    unknown, ///< of another machine
    runs,
    stopped, ///< by a signal or a debugger
    ended
};

/// @param here  this_process()
ProcessState state_of(ProcessId const& process, ProcessId const& here);

} // namespace viewer
