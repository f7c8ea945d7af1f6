#pragma once
// Simulates sensor noise for rendered light that is added to a camera's pictures.
// In units of the bytes, per channel:
//   variance(u) = constant + per_unit u
// (read noise and photon noise; Healey and Kondepudy 1994), with grain: the correlation of neighbouring pixels
// that demosaicking and compression cause.

#include <array>
#include <cstdint>
#include <opencv2/core.hpp>

namespace ar {

struct SensorNoise {
    std::array<float, 3> constant{}; ///< unit^2, >= 0
    std::array<float, 3> per_unit{}; ///< unit^2 per unit, >= 0
    float grain_sigma_px = 0;        ///< of the Gaussian that correlates neighbours; 0 = white noise
    std::uint64_t seed = 1;

    bool any() const;
    float variance(int channel, float unit) const
    {
        auto const c = std::size_t(channel);
        return constant[c] + per_unit[c] * (unit > 0 ? unit : 0);
    }
};

/// A tileable square of noise with mean 0 and variance 1; each frame uses a different offset into it.
class NoiseField {
public:
    static constexpr int kSize = 256; ///< pixels a side
    NoiseField() = default;
    explicit NoiseField(SensorNoise const& noise);

    /// CV_32FC3, kSize x kSize.
    cv::Mat const& tile() const { return tile_; }
    /// Position of the frame's pixel (0, 0) in the square.
    cv::Point offset(std::uint64_t frame) const;

private:
    cv::Mat tile_;
    std::uint64_t seed_ = 0;
};

} // namespace ar
