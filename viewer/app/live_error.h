#pragma once
// Measures the error of the live picture against a second method's.

#include "viewer/engine/live/live_renderer.h"

#include <future>
#include <optional>

namespace viewer {

/// Error of the method's picture relative to the second method's.
struct LiveError {
    std::uint64_t frame = 0;
    double relmse = 0, flip = 0; ///< flip: mean over the picture, at its exposure
};

/// Measures the error in the background, one frame at a time, so that neither input nor rendering waits.
class ErrorMeter {
public:
    /// Starts measuring a frame that has two pictures, unless a measurement is running.
    void see(std::shared_ptr<LiveFrame const> const& frame);
    /// The newest finished result.
    std::optional<LiveError> const& latest();

private:
    std::future<LiveError> running_;
    std::optional<LiveError> latest_;
};

} // namespace viewer
