#pragma once
// Frames that show their own number, as a machine reads it: what comes out of a chain tells which frame went in.
// The number is a row of 52 cells along the upper edge, a tenth of the picture high: white, black, 32 bits
// (highest first, 1 = white), 16 bits of CRC-16/CCITT of them, black, white. Below it moves a pattern.

#include "ar/capture/frame_source.h"
#include "ar/capture/tally.h"

namespace ar {

/// Pictures of at least 208 x 20 pixels, CV_8UC1 or CV_8UC3.
void draw_counter(cv::Mat& picture, std::uint32_t number);
/// Of CV_8UC1 or CV_8UC3, also scaled or after JPEG; nothing where there is none, or it cannot be read for sure.
std::optional<std::uint32_t> read_counter(cv::Mat const& picture);

struct CounterOptions {
    glm::ivec2 size_px{640, 480};
    double frames_per_s = 30;
    PixelFormat format = PixelFormat::rgb8; ///< or gray8, mjpeg
    std::uint64_t frames = 0;               ///< then it ends; 0 = never
    Pace pace = Pace::own; ///< fastest: every frame as soon as it is asked for, captured at that time
};

/// A camera that is not there. At its own pace frame n is captured at n / frames_per_s after the first call,
/// exactly (origin: sensor); what was not asked for in time is dropped.
class CounterSource final : public FrameSource {
public:
    /// @throws gi::InputError pictures too small for the row, a rate that is none
    explicit CounterSource(CounterOptions const& options = {});

    std::optional<Frame> next(std::chrono::milliseconds wait) override;
    SourceState state() const override;
    SourceDescription description() const override;
    SourceCounts counts() const override { return tally_.counts(); }
    std::vector<std::string> set(Controls const& controls) override;

private:
    std::uint64_t number_due() const;

    CounterOptions options_;
    Tally tally_;
    std::optional<double> start_s_;
    std::uint64_t next_ = 0;
};

} // namespace ar
