#pragma once
// A simulated camera that plays a fixed set of frames forwards and backwards in a loop.

#include "ar/capture/frame_source.h"
#include "ar/capture/tally.h"

namespace ar {

/// Frame n is captured exactly n / rate after the first call; frames not requested in time are dropped.
class LoopSource final : public FrameSource {
public:
    /// @param frames  at least one, all of the same size. @throws std::invalid_argument
    LoopSource(std::vector<Frame> frames, double rate_hz);

    /// Index of the stored frame that has the number `sequence`.
    std::size_t index_of(std::uint64_t sequence) const;
    std::optional<Frame> next(std::chrono::milliseconds wait) override;
    SourceState state() const override { return {}; }
    SourceDescription description() const override;
    SourceCounts counts() const override { return tally_.counts(); }
    std::vector<std::string> set(Controls const& controls) override;

private:
    std::vector<Frame> frames_;
    double rate_hz_;
    Tally tally_;
    std::optional<double> start_s_;
    std::uint64_t next_ = 0;
};

/// Reads at most `most` frames; fewer if the source ends, or no frame arrives for five seconds.
std::vector<Frame> read_frames(FrameSource& source, int most);

} // namespace ar
