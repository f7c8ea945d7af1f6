#pragma once
// Time at which a frame was taken, in seconds since the source's first frame.

#include "ar/capture/frame_source.h"

#include <optional>
#include <string>
#include <utility>

namespace ar {

/// Times of frames. Pictures read as fast as possible are timed by their numbers, as the clock does not show
/// the time that passes in them. Recordings keep their recorded times.
class FrameClock {
public:
    /// @param source  name for open_source  @param is_timed  frames come at their own pace
    FrameClock(std::string const& source, SourceDescription const& about, bool is_timed);

    /// The first frame passed has the time 0, unless the source says which number has it.
    double operator()(Frame const& frame);

private:
    double numbered_hz_ = 0; ///< 0 = use capture times
    std::optional<std::uint64_t> zero_;
    double hz_ = 0;
    double begins_s_ = 0; ///< time of the first frame
    std::optional<std::pair<std::uint64_t, double>> first_;
};

} // namespace ar
