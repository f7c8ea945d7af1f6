#pragma once
// When a frame was taken, in seconds since the first one of its source.

#include "ar/capture/frame_source.h"

#include <optional>
#include <string>
#include <utility>

namespace viewer {

/// Read as fast as possible, a clock says nothing of the time that passes in pictures: they go by their numbers.
/// Recordings keep the times that they were made at.
class FrameClock {
public:
    /// @param source  as ar::open_source takes it  @param is_timed  frames come at their own pace
    FrameClock(std::string const& source, ar::SourceDescription const& about, bool is_timed);

    /// The first frame that is asked for has the time 0.
    double operator()(ar::Frame const& frame);

private:
    double numbered_hz_ = 0; ///< 0 = by when they were captured
    std::optional<std::pair<std::uint64_t, double>> first_;
};

} // namespace viewer
