#pragma once
// Composites virtual objects into a camera's picture by differential rendering (Debevec 1998,
// section 5), in linear light:
//   out = a with + (1 - a)(camera + with - without) = with + (1 - a)(camera - without)
// a: share of the pixel that virtual objects cover. In antialiased pictures, with = a object + (1 - a) place, so
// this equals a object + (1 - a)(camera + change of the place), which is exact at borders, too.
//
// All is computed in units of the camera's bytes (ar/camera/photometry.h): with and without go through exposure,
// colour matrix and vignetting, then through the response to the nearest byte. Uncovered pixels where with equals
// without keep the camera's bytes. Frames of 16 bits and of linear radiance keep their depth. docs/methods/ar-light.md has
// the equations of the options.

#include "ar/camera/photometry.h"
#include "ar/composite/deep_response.h"
#include "ar/composite/rendered_pair.h"
#include "ar/composite/response_table.h"
#include "ar/composite/sensor_noise.h"

#include <array>
#include <cstdint>
#include <optional>

namespace ar {

/// How the pictures `with` and `without` change the camera's pixels.
enum class Blend {
    difference, ///< camera + with - without: exact if the model of the place is right
    /// camera with / without in uncovered pixels: errors of albedo cancel, but light added to very dark places is
    /// wrong. Differences replace ratios beyond the limit, and in partly covered pixels of pairs without `direct`.
    ratio
};

/// How to darken pixels whose camera byte is 255, so that the unit u is only a lower bound.
enum class ClippedBytes {
    as_measured, ///< takes the byte as exact: shadows in bright places become too dark
    ratio,       ///< u with / without: closer to the truth, and never above it if the model's ratio is right
    model        ///< max(u, without) with / without: exact if the model is right, else as for ratio
};

struct CompositeSettings {
    Blend blend = Blend::difference;
    ClippedBytes clipped = ClippedBytes::model;
    float largest_ratio = 8; ///< >= 1
    SensorNoise noise;       ///< noise for the added light; zero = none
};

/// Numbers of pixels; "values" are counted per channel.
struct CompositeCounts {
    std::size_t pixels = 0;
    std::size_t copied = 0;         ///< unchanged pixels, which keep the camera's bytes
    std::size_t covered = 0;        ///< coverage > 0
    std::size_t clipped = 0;        ///< changed, with a camera byte of 255: true brightness unknown
    std::size_t negative = 0;       ///< values below 0, clamped to 0
    std::size_t ratio_limited = 0;  ///< values whose ratio was beyond the limit
    std::size_t not_finite = 0;     ///< NaN or infinity in the rendered pair; the camera's bytes are kept
    std::size_t coverage_range = 0; ///< coverage below 0 or above 1, clamped

    CompositeCounts& operator+=(CompositeCounts const& other);
};

enum class Output; // codes or radiance; of the implementation

class Compositor {
public:
    /// @throws gi::InputError a colour matrix without inverse, settings out of range
    explicit Compositor(Photometry const& photometry, CompositeSettings const& settings = {});

    /// @param rgb      CV_8UC3, CV_16UC3 or CV_32FC3 RGB (picture_of), the camera's frame; not resampled
    /// @param pair     of the frame's size and lens (see Warp, upsampled)
    /// @param out      of the frame's type; its memory is reused if it fits; may be `rgb` itself
    /// @param frame    frame number, which selects the noise
    /// @throws gi::InputError wrong types or sizes
    CompositeCounts operator()(cv::Mat const& rgb, RenderedPair const& pair, Exposure const& exposure,
                               cv::Mat& out, std::uint64_t frame = 0);

    /// The composite as radiance, CV_32FC3: what the codes are made of, before noise and rounding.
    cv::Mat light(cv::Mat const& rgb, RenderedPair const& pair, Exposure const& exposure);

    /// For the same computation on the GPU (viewer/devices/gl).
    Photometry const& photometry() const { return photometry_; }
    CompositeSettings const& settings() const { return settings_; }
    ResponseTable const& response(int channel) const { return response_[std::size_t(channel)]; }
    /// Matrix from radiance (linear BT.709) to the camera's linear RGB: diag(gains) inverse(colour) /
    /// radiance_per_unit. The gains are those of the exposure relative to Photometry::reference.
    /// Vignetting is not included.
    cv::Matx33f unit_of_radiance(Exposure const& exposure) const;
    NoiseField const& noise() const { return noise_; }

private:
    cv::Matx33f radiance_to_unit() const; ///< of linear frames
    template <Output kOutput>
    CompositeCounts by_depth(cv::Mat const& rgb, RenderedPair const& pair, Exposure const& exposure, cv::Mat& out,
                             std::uint64_t frame_number);
    template <Output kOutput, typename Response>
    CompositeCounts composited(cv::Mat const& rgb, RenderedPair const& pair,
                               std::array<Response, 3> const& response, cv::Matx33f const& to_unit,
                               cv::Mat const& vignetting, cv::Mat& out, std::uint64_t frame_number) const;

    Photometry photometry_;
    CompositeSettings settings_;
    std::array<ResponseTable, 3> response_;
    std::optional<std::array<DeepResponse, 3>> deep_response_; ///< from the first frame of 16 bits on
    cv::Matx33f camera_colour_;
    NoiseField noise_;
    cv::Mat vignetting_; ///< CV_32FC1 of the last frame's size; empty without vignetting
};

} // namespace ar
