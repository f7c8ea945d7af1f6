#include "ar/base/rotation_fit.h"

#include "ar/base/pose.h"

#include <cmath>
#include <opencv2/core.hpp>

namespace ar {

std::optional<glm::dquat> rotation_fit(std::span<glm::dvec3 const> from, std::span<glm::dvec3 const> to,
                                       std::span<double const> weights)
{
    CV_Assert(from.size() == to.size() && (weights.empty() || weights.size() == from.size()));
    cv::Matx33d sum = cv::Matx33d::zeros();
    for (std::size_t i = 0; i < from.size(); ++i)
        for (int r = 0; r < 3; ++r)
            for (int c = 0; c < 3; ++c) sum(r, c) += (weights.empty() ? 1 : weights[i]) * to[i][r] * from[i][c];
    for (double const v : sum.val)
        if (!std::isfinite(v)) return std::nullopt;
    cv::Matx33d u, vt;
    cv::Vec3d w;
    cv::SVD::compute(sum, w, u, vt);
    if (!(w[1] > 1e-9 * w[0])) return std::nullopt;
    double const sign = cv::determinant(u * vt) < 0 ? -1 : 1;
    // Where only a reflection fits well, the axis of the smallest value is free unless that value is unlike.
    if (sign < 0 && !(w[1] - w[2] > 1e-9 * w[0])) return std::nullopt;
    cv::Matx33d const r = u * cv::Matx33d::diag({1, 1, sign}) * vt;
    glm::dmat3 m;
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column) m[column][row] = r(row, column);
    return glm::normalize(glm::quat_cast(m));
}

glm::dquat exp_rotation(glm::dvec3 v) { return pose_of({v.x, v.y, v.z}, {}).rotation; }

glm::dvec3 log_rotation(glm::dquat const& rotation)
{
    cv::Vec3d const v = rotation_vector({rotation, {}});
    return {v[0], v[1], v[2]};
}

} // namespace ar
