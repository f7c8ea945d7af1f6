#pragma once
// Virtual objects in a camera's picture by differential rendering (Debevec 1998, section 5), in linear light:
//   out = a with + (1 - a)(camera + with - without) = with + (1 - a)(camera - without)
// a: part of the pixel that virtual objects cover. Where with = a object + (1 - a) place, as antialiased pictures
// are, this is a object + (1 - a)(camera + change of the place): exact at borders, too.
//
// All is computed in units of the camera's bytes (ar/camera/photometry.h): with and without go through exposure,
// colour matrix and vignetting, then through the response to the nearest byte. Bytes of pixels that nothing covers
// and where with equals without are copied. docs/methods.md has the equations of the options.

#include "ar/camera/photometry.h"
#include "ar/composite/rendered_pair.h"
#include "ar/composite/response_table.h"
#include "ar/composite/sensor_noise.h"

#include <array>
#include <cstdint>

namespace ar {

/// What with and without do to what the camera sees.
enum class Blend {
    difference, ///< camera + with - without: exact when the model of the place is right
    /// camera with / without where nothing covers: errors of albedo cancel, light where there was next to none
    /// does not come out right. Ratios beyond the limit are differences, and so are partly covered pixels of pairs
    /// without `direct`.
    ratio
};

/// What is darkened where a byte of the camera is 255 and so only the least value of the unit u is known.
enum class ClippedBytes {
    as_measured, ///< as if the byte said the truth: shadows of bright places come out too dark
    ratio,       ///< u with / without: nearer to the truth, and never above it if the model's ratio is right
    model        ///< max(u, without) with / without: the truth where the model is right, else as for ratio
};

struct CompositeSettings {
    Blend blend = Blend::difference;
    ClippedBytes clipped = ClippedBytes::model;
    float largest_ratio = 8; ///< >= 1
    SensorNoise noise;       ///< of what is added; zero = none
};

/// Pixels, but where it says values: those are of channels.
struct CompositeCounts {
    std::size_t pixels = 0;
    std::size_t copied = 0;         ///< the camera's bytes, since nothing was changed
    std::size_t covered = 0;        ///< coverage > 0
    std::size_t clipped = 0;        ///< changed, with a byte of 255: how bright the place is, is not known
    std::size_t negative = 0;       ///< values below 0, made 0
    std::size_t ratio_limited = 0;  ///< values whose ratio was beyond the limit
    std::size_t not_finite = 0;     ///< NaN or infinite in what was rendered: the camera's bytes
    std::size_t coverage_range = 0; ///< coverage below 0 or above 1, clamped

    CompositeCounts& operator+=(CompositeCounts const& other);
};

class Compositor {
public:
    /// @throws gi::InputError a colour matrix without inverse, settings out of range
    explicit Compositor(Photometry const& photometry, CompositeSettings const& settings = {});

    /// @param rgb      CV_8UC3 RGB, the camera's frame; not resampled
    /// @param pair     of the frame's size and lens (see Warp, upsampled)
    /// @param out      CV_8UC3; its memory is used again where it fits; may be `rgb` itself
    /// @param frame    number of the frame: chooses the noise
    /// @throws gi::InputError types or sizes
    CompositeCounts operator()(cv::Mat const& rgb, RenderedPair const& pair, Exposure const& exposure,
                               cv::Mat& out, std::uint64_t frame = 0);

    /// For the same work elsewhere (viewer/devices/gl).
    Photometry const& photometry() const { return photometry_; }
    CompositeSettings const& settings() const { return settings_; }
    ResponseTable const& response(int channel) const { return response_[std::size_t(channel)]; }
    /// Unit of camera RGB of radiance: gains colour^-1 / radiance_per_unit, without vignetting.
    cv::Matx33f unit_of_radiance(Exposure const& exposure) const;
    NoiseField const& noise() const { return noise_; }

private:
    Photometry photometry_;
    CompositeSettings settings_;
    std::array<ResponseTable, 3> response_;
    cv::Matx33f camera_colour_;
    NoiseField noise_;
    cv::Mat vignetting_; ///< CV_32FC1 of the last frame's size; empty without vignetting
};

} // namespace ar
