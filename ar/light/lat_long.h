#pragma once
// Environment maps: the radiance that arrives from every direction, CV_32FC3, linear RGB, twice as wide as high.
//   u = 0.5 + atan2(x, -z) / 2 pi,  v = acos(y) / pi   (y up; v = 0 is the top row's upper edge; -z in the middle)
// The texel (column i, row j) spans u from i / width to (i + 1) / width, and v likewise.

#include "ar/camera/pose.h"

#include <opencv2/core.hpp>
#include <optional>
#include <span>
#include <string>

namespace ar {

/// (u, v), both 0..1, of a direction of length 1.
glm::dvec2 uv_of(glm::dvec3 direction);
glm::dvec3 direction_of_uv(glm::dvec2 uv);
/// Direction of a texel's centre.
glm::dvec3 texel_direction(cv::Size map, int column, int row);
/// Exact solid angle of a texel: 2 pi / width (cos of upper edge - cos of lower edge).
double texel_sr(cv::Size map, int row);

/// Bilinear interpolation between texel centres; u wraps, v is clamped at the poles.
cv::Vec3f sample(cv::Mat const& map, glm::dvec3 direction);

/// Integral of radiance over the whole sphere, W / m^2; divided by 4 pi it is the mean radiance.
cv::Vec3d integral(cv::Mat const& map);

/// Resamples to another frame of reference and size: the mean over each texel's solid angle, by a grid of samples
/// as dense as the source.
/// @param to_from takes directions of `map` to directions of the result
cv::Mat resampled(cv::Mat const& map, cv::Size size, glm::dquat const& to_from = {1, 0, 0, 0});

/// @throws gi::InputError empty, not CV_32FC3, not 2 : 1, not finite, negative; `where` begins the message
void check_map(cv::Mat const& map, std::string const& where);

/// Measured part of an environment. The weight is the quality of the measurement; 0 = not measured.
struct PartialMap {
    cv::Mat radiance; ///< CV_32FC3, 0 where the weight is 0
    cv::Mat weight;   ///< CV_32FC1
};
/// Share of the sphere's solid angle with weight > 0.
double covered_share(PartialMap const& map);
/// Weighted mean of the maps that saw each direction. All maps must have the same size.
PartialMap merged(std::span<PartialMap const> maps);

struct FilledMap {
    cv::Mat radiance;
    int filled_texels = 0;
    double filled_share = 0; ///< of the sphere
};
/// Fills unmeasured texels by solving Laplace's equation on the sphere with the measured
/// ones as boundary, from coarse to fine.
/// @throws gi::InputError if nothing was measured at all
FilledMap filled(PartialMap const& map);

/// Irradiance of a face with that normal, W/m^2: E(n) = integral of L(w) max(0, n.w) dw, summed over all texels.
cv::Vec3d irradiance_exact(cv::Mat const& map, glm::dvec3 normal);

} // namespace ar
