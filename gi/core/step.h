#pragma once
// Progress of long work: code that loads or builds announces its steps,
// and a listener on the same thread shows them.

#include "gi/core/progress.h"

#include <cstdint>
#include <functional>
#include <string>

namespace gi {

struct Step {
    std::string what;               ///< "textures decoded", "build (hit buffers)"
    std::uint64_t done = 0, of = 0; ///< "3 of 24"; of = 0: its parts are not counted

    bool operator==(Step const&) const = default;
};

/// Receives the steps of this thread while it exists, instead of an earlier listener.
/// An exception that it throws (Interrupted, to end the work) propagates out of the work.
class StepListener {
public:
    /// @param stop  of the work, must outlive this object; null = it cannot be stopped between steps
    explicit StepListener(std::function<void(Step const&)> hear, StopRequest const* stop = nullptr);
    ~StepListener();
    StepListener(StepListener const&) = delete;
    StepListener& operator=(StepListener const&) = delete;

private:
    friend void at_step(char const*, std::uint64_t, std::uint64_t);
    friend StopRequest const* stop_of_steps();
    StopRequest const* stop_;
    std::function<void(Step const&)> hear_;
    StepListener* before_;
};

/// Says that this thread's work begins a step, or has done `done` parts of it. Throws what the listener throws, so
/// call it only where the work may be abandoned; on a thread without a listener it does nothing.
void at_step(char const* what, std::uint64_t done = 0, std::uint64_t of = 0);
/// Whether this thread's work should stop, for long parts of a step; null on a thread without such a listener.
StopRequest const* stop_of_steps();
/// For builders: their own request, or if there is none, that of the steps.
inline StopRequest const* stop_of_building(StopRequest const* own)
{
    return own != nullptr ? own : stop_of_steps();
}

} // namespace gi
