#pragma once
// Generates frames that show their own number in machine-readable form, so the output of a processing chain
// identifies the input frame. The number is a row of 52 cells along the upper edge, a tenth of the picture high:
// white, black, 32 bits (highest first, 1 = white), 16 bits of their CRC-16/CCITT, black, white.
// A moving pattern fills the rest.

#include "ar/capture/frame_source.h"
#include "ar/capture/tally.h"

namespace ar {

/// Draws the number into a picture of at least 208 x 20 pixels, CV_8UC1 or CV_8UC3.
void draw_counter(cv::Mat& picture, std::uint32_t number);
/// Reads the number of a CV_8UC1 or CV_8UC3 picture, also scaled or JPEG-compressed; nothing if there is none or
/// it cannot be read reliably.
std::optional<std::uint32_t> read_counter(cv::Mat const& picture);

struct CounterOptions {
    glm::ivec2 size_px{640, 480};
    double frames_per_s = 30;
    PixelFormat format = PixelFormat::rgb8; ///< or gray8, mjpeg
    std::uint64_t frames = 0;               ///< number of frames before it ends; 0 = endless
    Pace pace = Pace::own; ///< fastest: every frame as soon as it is requested, captured at that time
};

/// A simulated camera. At its own pace, frame n is captured exactly n / frames_per_s after the first call (origin:
/// sensor); frames not requested in time are dropped.
class CounterSource final : public FrameSource {
public:
    /// @throws gi::InputError pictures too small for the row of cells, an invalid rate
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
