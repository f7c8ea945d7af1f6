#include "ar/camera/pose.h"

#include <cmath>

namespace ar {

gi::RigidPose pose_of(cv::Vec3d const& r, cv::Vec3d const& t)
{
    return {{t[0], t[1], t[2]}, gi::exp_rotation({r[0], r[1], r[2]})};
}

cv::Vec3d rotation_vector(gi::RigidPose const& p)
{
    glm::dvec3 const v = gi::log_rotation(p.rotation);
    return {v.x, v.y, v.z};
}

double angle_between_deg(glm::dquat const& a, glm::dquat const& b)
{
    glm::dquat const d = glm::conjugate(a) * b;
    return glm::degrees(2 * std::atan2(glm::length(glm::dvec3(d.x, d.y, d.z)), std::abs(d.w)));
}

} // namespace ar
