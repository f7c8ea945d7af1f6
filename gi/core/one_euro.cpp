#include "gi/core/one_euro.h"

#include "gi/core/rotation.h"

namespace gi {
namespace {

constexpr double kSettled = 1e-5; // m, rad; m/s, rad/s

/// Nearer than anybody sees, what is at rest has arrived: else it would come nearer for ever, and be new each time.
dvec3 settled(dvec3 rest) { return glm::length(rest) < kSettled ? dvec3{0} : rest; }

double time_constant(double cutoff_hz) { return 1 / (2 * 3.14159265358979323846 * cutoff_hz); }

double share(double cutoff_hz, double dt_s) { return dt_s / (dt_s + time_constant(cutoff_hz)); }

/// Brings both velocities on, returns the cutoff.
double update_velocities(OneEuroSettings const& s, dvec3 measured, double dt_s, dvec3& velocity, dvec3& slow)
{
    slow += share(s.speed_cutoff_hz, dt_s) * (measured - slow);
    double const speed = glm::length(slow);
    velocity = settled(velocity +
                       share(s.velocity_min_cutoff_hz + s.velocity_beta * speed, dt_s) * (measured - velocity));
    return s.min_cutoff_hz + s.beta * speed;
}

} // namespace

OneEuroPosition start(dvec3 position)
{
    OneEuroPosition f;
    f.raw = f.value = position;
    return f;
}

OneEuroRotation start(dquat const& rotation)
{
    OneEuroRotation f;
    f.raw = f.value = rotation;
    return f;
}

OneEuroPosition step(OneEuroSettings const& settings, OneEuroPosition const& before, dvec3 position, double dt_s)
{
    OneEuroPosition f = before;
    double const cutoff =
        update_velocities(settings, (position - before.raw) / dt_s, dt_s, f.velocity, f.slow_velocity);
    f.raw = position;
    f.value = position - settled((1 - share(cutoff, dt_s)) * (position - before.value));
    f.lag_s = time_constant(cutoff);
    return f;
}

OneEuroRotation step(OneEuroSettings const& settings, OneEuroRotation const& before, dquat const& rotation,
                     double dt_s)
{
    OneEuroRotation f = before;
    double const cutoff = update_velocities(settings, log_rotation(glm::inverse(before.raw) * rotation) / dt_s,
                                            dt_s, f.velocity, f.slow_velocity);
    f.raw = rotation;
    dvec3 const ahead = log_rotation(glm::inverse(before.value) * rotation);
    double const taken = share(cutoff, dt_s);
    bool const arrives = settled((1 - taken) * ahead) == dvec3{0};
    f.value = arrives ? rotation : glm::normalize(before.value * exp_rotation(taken * ahead));
    f.lag_s = time_constant(cutoff);
    return f;
}

} // namespace gi
