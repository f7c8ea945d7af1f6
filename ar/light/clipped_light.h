#pragma once
// The sun and lamps that a light probe clips in its shortest exposure: what is missing, and its estimate from the
// irradiance of a surface of known albedo beside the probe (as a diffuse ball does in Debevec et al. 2012).
//
// The measured map gives a lower bound E_map(n) of the irradiance. White paper of normal n and albedo a with the
// radiance L shows E(n) = pi L / a. The difference is light of the clipped texels, towards w:
//   missing(w) = (E(n) - E_map(n)) / n.w      (of a face turned to it, channel by channel)

#include "ar/light/lat_long.h"

#include <optional>

namespace ar {

/// Irradiance of a face that was measured by its own radiance.
struct MeasuredFace {
    glm::dvec3 normal{0, 1, 0};
    cv::Vec3d irradiance{0, 0, 0};
};

struct ClippedLight {
    double clipped_sr = 0;       ///< solid angle of clipped texels; 0 = none
    glm::dvec3 towards{0, 1, 0}; ///< their middle, weighted by light
    cv::Vec3d as_measured;       ///< irradiance of a face turned there, a lower bound
    cv::Vec3d added{0, 0, 0};    ///< by the repair, likewise; 0 = not repaired
    bool repaired = false;
    /// A face towards this normal receives clipped light (n.w > 0): unless repaired,
    /// its irradiance is a lower bound.
    bool lights(glm::dvec3 normal) const { return clipped_sr > 0 && glm::dot(normal, towards) > 0; }
};

/// Finds the clipped light and, if a face is given that it falls on, adds what is missing to the clipped texels.
/// @param[in,out] map  lat-long radiance
/// @param clipped  CV_32FC1 of its size: share of each texel whose measurement was clipped, 0..1
/// @param face  nothing: only detect. A face that clipped light reaches at less than 0.15 of its power is not used
ClippedLight repair_clipped(cv::Mat& map, cv::Mat const& clipped, std::optional<MeasuredFace> const& face);

} // namespace ar
