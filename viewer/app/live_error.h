#pragma once
#include "viewer/engine/live/live_renderer.h"

#include <future>
#include <optional>

namespace viewer {

/// How far the picture of the method is from that of the second one.
struct LiveError {
    std::uint64_t frame = 0;
    double relmse = 0, flip = 0; ///< flip: mean over the picture, at its exposure
};

/// Measures in the background, one frame at a time, so that neither input nor rendering waits.
class ErrorMeter {
public:
    /// Starts on a frame that has two pictures, unless one is being measured.
    void see(std::shared_ptr<LiveFrame const> const& frame);
    /// The newest that is finished.
    std::optional<LiveError> const& latest();

private:
    std::future<LiveError> running_;
    std::optional<LiveError> latest_;
};

} // namespace viewer
