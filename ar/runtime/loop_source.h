#pragma once
// A camera that is not there: it sees frames that were read before, forwards and backwards again and again.

#include "ar/capture/frame_source.h"
#include "ar/capture/tally.h"

namespace viewer {

/// Frame n is captured n / rate after the first call, exactly; what was not asked for in time is dropped.
class LoopSource final : public ar::FrameSource {
public:
    /// @param frames  at least one, of one size. @throws std::invalid_argument
    LoopSource(std::vector<ar::Frame> frames, double rate_hz);

    /// Which of the frames read before is number `sequence`.
    std::size_t index_of(std::uint64_t sequence) const;
    std::optional<ar::Frame> next(std::chrono::milliseconds wait) override;
    ar::SourceState state() const override { return {}; }
    ar::SourceDescription description() const override;
    ar::SourceCounts counts() const override { return tally_.counts(); }
    std::vector<std::string> set(ar::Controls const& controls) override;

private:
    std::vector<ar::Frame> frames_;
    double rate_hz_;
    ar::Tally tally_;
    std::optional<double> start_s_;
    std::uint64_t next_ = 0;
};

/// At most so many; fewer where the source ends, or nothing comes for five seconds.
std::vector<ar::Frame> read_frames(ar::FrameSource& source, int most);

} // namespace viewer
