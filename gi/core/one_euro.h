#pragma once
// The one-euro filter (Casiez, Roussel, Vogel 2012, "1€ Filter: A Simple Speed-based Low-pass Filter for Noisy
// Input in Interactive Systems", CHI): a low-pass of first order whose cutoff rises with speed,
//   fc = min_cutoff + beta |v|,  tau = 1 / (2 pi fc),  alpha = dt / (dt + tau),  y += alpha (x - y).
// Here v comes from successive inputs and not, as in the paper's listing, from input and last output:
// it then is that of the motion and can be used to predict; its own cutoff rises likewise,
// so that noise at rest is not extrapolated. What is within 1e-5 (m, rad, and of their velocities a second) of its end has reached it.

#include "gi/core/math.h"

namespace gi {

struct OneEuroSettings {
    double min_cutoff_hz = 1;          ///< at rest: lower = steadier, slower
    double beta = 1;                   ///< Hz per m/s, or per rad/s: higher = less lag in motion
    double speed_cutoff_hz = 1;        ///< of the speed that the cutoffs follow (the paper's dcutoff)
    double velocity_min_cutoff_hz = 1; ///< of the velocity that predictions use, at rest
    double velocity_beta = 1;          ///< its rise, as beta

    bool operator==(OneEuroSettings const&) const = default;
};

/// The filter's memory, a plain value: late samples take it back to where they belong.
struct OneEuroPosition {
    dvec3 raw{0}, value{0}; ///< m
    dvec3 velocity{0};      ///< m/s, for predictions
    dvec3 slow_velocity{0}; ///< m/s, for the cutoff
    double lag_s = 0;       ///< by which value is behind a constant motion: tau
};

/// Rotations in the log map: x - y is the rotation vector from the output to the input, in the body's frame.
struct OneEuroRotation {
    dquat raw{1, 0, 0, 0}, value{1, 0, 0, 0};
    dvec3 velocity{0};      ///< rad/s about the body's axes
    dvec3 slow_velocity{0}; ///< rad/s
    double lag_s = 0;
};

OneEuroPosition start(dvec3 position);
OneEuroRotation start(dquat const& rotation);
/// @param dt_s since the sample before, > 0
OneEuroPosition step(OneEuroSettings const& settings, OneEuroPosition const& before, dvec3 position, double dt_s);
OneEuroRotation step(OneEuroSettings const& settings, OneEuroRotation const& before, dquat const& rotation,
                     double dt_s);

} // namespace gi
