#include "gi/scene/motion/inverse_kinematics.h"

#include <algorithm>
#include <cmath>

namespace gi {
namespace {

/// Returns the unit vector perpendicular to a unit direction that is closest to `wish`.
dvec3 perpendicular(dvec3 direction, dvec3 wish)
{
    double const length = glm::length(wish);
    if (length > 0) {
        dvec3 const unit = wish / length, side = unit - glm::dot(unit, direction) * direction;
        if (glm::length(side) > 1e-9) return glm::normalize(side);
    }
    dvec3 axis{0};
    int smallest = 0;
    for (int k = 1; k < 3; ++k)
        if (std::abs(direction[k]) < std::abs(direction[smallest])) smallest = k;
    axis[smallest] = 1;
    return glm::normalize(axis - direction[smallest] * direction);
}

} // namespace

TwoBones reach(dvec3 root, double upper_m, double lower_m, dvec3 target, dvec3 pole)
{
    double const length = upper_m + lower_m;
    if (!(length > 0)) return {root, root};
    double distance = glm::distance(root, target);
    dvec3 direction, side;
    if (distance > 1e-12 * length) {
        direction = (target - root) / distance;
        side = perpendicular(direction, pole);
    } else {
        distance = 0;
        side = glm::length(pole) > 0 ? glm::normalize(pole) : dvec3{0, -1, 0};
        direction = perpendicular(side, dvec3{0});
    }
    double const d = std::clamp(distance, std::abs(upper_m - lower_m), length);
    // From u^2 = x^2 + h^2 and l^2 = (d - x)^2 + h^2.
    double const along =
        d > 0 ? std::clamp(0.5 * d + 0.5 * (upper_m - lower_m) * length / d, -upper_m, upper_m) : 0;
    double const aside = std::sqrt(std::max(0.0, (upper_m - along) * (upper_m + along)));
    return {root + along * direction + aside * side, root + d * direction};
}

dquat turn_between(dvec3 from, dvec3 to, dvec3 hint)
{
    double const a = glm::length(from), b = glm::length(to);
    if (!(a > 0) || !(b > 0)) return {1, 0, 0, 0};
    dvec3 const u = from / a, v = to / b, axis = glm::cross(u, v);
    double const cosine = glm::dot(u, v), sine = glm::length(axis);
    if (cosine > 0) return glm::normalize(dquat(1 + cosine, axis));
    if (sine < 1e-8) return {0, glm::cross(u, perpendicular(u, hint))};
    return glm::angleAxis(std::atan2(sine, cosine), axis / sine);
}

} // namespace gi
