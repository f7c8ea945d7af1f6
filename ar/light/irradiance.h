#pragma once
// Irradiance from an environment map: E(n) = integral of L(w) max(0, n.w) dw, W/m^2.

#include "ar/light/lat_long.h"

namespace ar {

/// Irradiance of a face with that normal, summed over all texels.
cv::Vec3d irradiance_exact(cv::Mat const& map, glm::dvec3 normal);

} // namespace ar
