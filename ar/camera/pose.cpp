#include "ar/camera/pose.h"

#include "gi/core/rotation.h"

#include <cmath>

namespace ar {

glm::dvec3 operator*(Pose const& a_from_b, glm::dvec3 point_b)
{
    return a_from_b.rotation * point_b + a_from_b.position_m;
}

Pose operator*(Pose const& a_from_b, Pose const& b_from_c)
{
    return {glm::normalize(a_from_b.rotation * b_from_c.rotation), a_from_b * b_from_c.position_m};
}

Pose inverse(Pose const& a_from_b)
{
    glm::dquat const back = glm::conjugate(a_from_b.rotation);
    return {back, -(back * a_from_b.position_m)};
}

Pose pose_of(cv::Vec3d const& r, cv::Vec3d const& t)
{
    return {gi::exp_rotation({r[0], r[1], r[2]}), {t[0], t[1], t[2]}};
}

cv::Vec3d rotation_vector(Pose const& p)
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
