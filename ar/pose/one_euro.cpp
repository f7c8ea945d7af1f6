#include "ar/pose/one_euro.h"

#include "ar/camera/rotation_vector.h"

#include <numbers>

namespace ar {
namespace {

double share(double cutoff_hz, double dt_s) { return dt_s / (dt_s + 1 / (2 * std::numbers::pi * cutoff_hz)); }

/// How much of the way to the input the value goes.
double follow(OneEuroSettings const& s, OneEuroState& f, glm::dvec3 moved, double dt_s)
{
    glm::dvec3 const measured = moved / dt_s;
    f.slow_velocity += share(s.speed_cutoff_hz, dt_s) * (measured - f.slow_velocity);
    double const speed = glm::length(f.slow_velocity);
    f.velocity += share(s.velocity_min_cutoff_hz + s.velocity_beta * speed, dt_s) * (measured - f.velocity);
    double const part = share(s.min_cutoff_hz + s.beta * speed, dt_s);
    f.lag_s = dt_s * (1 - part) / part; // of y += part (x - y) behind a ramp
    return part;
}

} // namespace

OneEuroPose::OneEuroPose(OneEuroSettings const& position, OneEuroSettings const& rotation)
    : position_settings_(position), rotation_settings_(rotation)
{
}

void OneEuroPose::restart(Pose const& pose)
{
    input_ = value_ = pose;
    position_ = rotation_ = {};
}

void OneEuroPose::step(Pose const& pose, double dt_s)
{
    glm::dvec3 const turned = log_rotation(glm::conjugate(input_.rotation) * pose.rotation);
    double const part = follow(position_settings_, position_, pose.position_m - input_.position_m, dt_s);
    double const turn = follow(rotation_settings_, rotation_, turned, dt_s);
    value_.position_m += part * (pose.position_m - value_.position_m);
    value_.rotation = glm::normalize(
        value_.rotation * exp_rotation(turn * log_rotation(glm::conjugate(value_.rotation) * pose.rotation)));
    input_ = pose;
}

Pose OneEuroPose::moved_on(double ahead_s) const
{
    return {glm::normalize(value_.rotation * exp_rotation((ahead_s + rotation_.lag_s) * rotation_.velocity)),
            value_.position_m + (ahead_s + position_.lag_s) * position_.velocity};
}

} // namespace ar
