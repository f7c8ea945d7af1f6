#include "gi/core/rotation.h"

namespace gi {

dvec3 log_rotation(dquat q)
{
    if (q.w < 0) q = -q;
    dvec3 const v{q.x, q.y, q.z};
    double const sine = glm::length(v);
    if (sine < 1e-12) return 2.0 * v;
    return v * (2 * std::atan2(sine, q.w) / sine);
}

dquat exp_rotation(dvec3 r)
{
    double const angle = glm::length(r);
    double const scale = angle < 1e-12 ? 0.5 : std::sin(0.5 * angle) / angle;
    return glm::normalize(dquat(std::cos(0.5 * angle), r.x * scale, r.y * scale, r.z * scale));
}

dvec3 heading(dquat const& body)
{
    dvec3 const forward = body * dvec3{0, 0, -1}, top = body * dvec3{0, 1, 0};
    return {forward.x - forward.y * top.x, 0, forward.z - forward.y * top.z};
}

dquat heading_of(dquat const& body)
{
    dvec3 const faced = heading(body);
    return exp_rotation({0, std::atan2(-faced.x, -faced.z), 0});
}

} // namespace gi
