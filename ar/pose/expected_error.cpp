#include "ar/pose/expected_error.h"

#include <algorithm>
#include <cmath>

namespace ar {

std::optional<double> expected_error(PoseEstimate const& e)
{
    auto const spread = [](cv::Matx66d const& c) { return std::max(0.0, c(0, 0) + c(1, 1) + c(2, 2)); };
    if (!e.found() || !(spread(e.covariance) > 0)) return std::nullopt;
    double const own = spread(e.covariance);
    if (!e.other) return std::sqrt(own);
    glm::dvec3 const apart = e.other->position - e.world_from_camera.position;
    double const likely = std::clamp(e.other_likelihood, 0.0, 1.0);
    return std::sqrt((1 - likely) * own +
                     likely * (std::max(own, spread(e.other_covariance)) + glm::dot(apart, apart)));
}

} // namespace ar
