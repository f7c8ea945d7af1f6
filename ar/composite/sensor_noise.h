#pragma once
// Noise of a camera's sensor for what is rendered into its pictures. In units of the bytes, channel by channel:
//   variance(u) = constant + per_unit u
// (read noise and photon noise; Healey and Kondepudy 1994), with grain: what demosaicking and compression make of
// neighbours that were independent.

#include <array>
#include <cstdint>
#include <opencv2/core.hpp>

namespace ar {

struct SensorNoise {
    std::array<float, 3> constant{}; ///< unit^2, >= 0
    std::array<float, 3> per_unit{}; ///< unit^2 per unit, >= 0
    float grain_sigma_px = 0;        ///< of the Gaussian that neighbours share; 0 = white
    std::uint64_t seed = 1;

    bool any() const;
    float variance(int channel, float unit) const
    {
        auto const c = std::size_t(channel);
        return constant[c] + per_unit[c] * (unit > 0 ? unit : 0);
    }
};

/// A square of noise of mean 0 and variance 1 that joins at its borders; each frame begins at another place of it.
class NoiseField {
public:
    static constexpr int kSize = 256; ///< pixels a side
    NoiseField() = default;
    explicit NoiseField(SensorNoise const& noise);

    /// CV_32FC3, kSize x kSize.
    cv::Mat const& tile() const { return tile_; }
    /// Where pixel (0, 0) of the frame lies in the square.
    cv::Point offset(std::uint64_t frame) const;

private:
    cv::Mat tile_;
    std::uint64_t seed_ = 0;
};

} // namespace ar
