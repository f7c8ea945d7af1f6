#pragma once
// What an environment does to matt faces: irradiance E(n) = integral of L(w) max(0, n.w) dw, W/m^2.

#include "ar/light/lat_long.h"

#include <array>

namespace ar {

/// Real spherical harmonics up to order 2, l = 0: 1, l = 1: y z x, l = 2: xy yz 3z^2-1 xz x^2-y^2 (Ramamoorthi and
/// Hanrahan 2001, "An Efficient Representation for Irradiance Environment Maps"), of each channel.
using Harmonics9 = std::array<cv::Vec3d, 9>;
Harmonics9 harmonics_of(cv::Mat const& map);
/// Their E(n) = sum A_l L_lm Y_lm(n), A = pi, 2 pi / 3, pi / 4. Within 3 % of the truth on the mean for most
/// environments, 9 % at worst (same paper); may be slightly negative opposite a single lamp.
cv::Vec3d irradiance(Harmonics9 const& harmonics, glm::dvec3 normal);
/// The sum over all texels.
cv::Vec3d irradiance_exact(cv::Mat const& map, glm::dvec3 normal);

enum class IrradianceBy { harmonics, exact_sum };
/// CV_32FC3, lat-long by normal.
cv::Mat irradiance_map(cv::Mat const& map, cv::Size size = {64, 32}, IrradianceBy by = IrradianceBy::harmonics);

/// Mean over the sphere and channels of (x - r)^2 / (r^2 + 0.01 m^2), m = the mean of r: of two irradiance maps of
/// one size.
double relative_error2(cv::Mat const& irradiance, cv::Mat const& reference);

} // namespace ar
