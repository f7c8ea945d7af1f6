#pragma once
// What an environment does to matt faces: irradiance E(n) = integral of L(w) max(0, n.w) dw, W/m^2.

#include "ar/light/lat_long.h"

namespace ar {

/// The sum over all texels.
cv::Vec3d irradiance_exact(cv::Mat const& map, glm::dvec3 normal);

} // namespace ar
