#include "gi/core/pose.h"

namespace gi {

RigidPose operator*(RigidPose const& a, RigidPose const& b)
{
    return {a * b.position, glm::normalize(a.rotation * b.rotation)};
}

dvec3 operator*(RigidPose const& a, dvec3 const& point) { return a.position + a.rotation * point; }

RigidPose inverse(RigidPose const& pose)
{
    dquat const back = glm::conjugate(pose.rotation);
    return {-(back * pose.position), back};
}

RigidPose between(RigidPose const& a, RigidPose const& b, double t)
{
    return {a.position + t * (b.position - a.position),
            glm::normalize(a.rotation * exp_rotation(t * log_rotation(glm::inverse(a.rotation) * b.rotation)))};
}

bool is_finite(RigidPose const& p)
{
    dvec3 const v = p.position;
    dquat const q = p.rotation;
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z) && std::isfinite(q.w) &&
           std::isfinite(q.x) && std::isfinite(q.y) && std::isfinite(q.z);
}

} // namespace gi
