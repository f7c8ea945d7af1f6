#pragma once
// FLIP (Andersson et al. 2020) and HDR-FLIP (Andersson et al. 2021): the difference visible to an observer when
// two pictures alternate, per pixel 0..1.

#include <vector>

namespace gi {

inline constexpr float kPixelsPerDegree = 67.02064f; ///< 0.7 m from a display 0.7 m wide with 3840 pixels

struct FlipExposures {
    float first_ev, last_ev;
    int count;
};

/// @param image, reference  width * height * 3 linear Rec. 709 values in [0, 1]
///   (decode display-encoded ones first)
/// @return one value per pixel
std::vector<float> flip(std::vector<float> const& image, std::vector<float> const& reference, int width,
                        int height, float pixels_per_degree = kPixelsPerDegree);
/// Returns the range of exposures from barely to fully exposed for the reference (linear radiance).
FlipExposures flip_exposures(std::vector<float> const& reference);
/// Returns the per-pixel maximum of FLIP over these exposures, tone-mapped by ACES.
/// Linear radiance, any range >= 0.
std::vector<float> hdr_flip(std::vector<float> const& image, std::vector<float> const& reference, int width,
                            int height, float pixels_per_degree = kPixelsPerDegree);

} // namespace gi
