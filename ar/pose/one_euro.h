#pragma once
// The one-euro filter (Casiez, Roussel, Vogel 2012, "1 Euro Filter: A Simple Speed-based Low-pass Filter for Noisy
// Input in Interactive Systems", CHI) of a pose: a low-pass of first order whose cutoff rises with speed,
//   fc = min_cutoff + beta |v|,  tau = 1 / (2 pi fc),  share = dt / (dt + tau),  value += share (input - value).
// v comes from successive inputs, as in viewer/devices/tracking: it is that of the motion and serves to predict.

#include "ar/camera/pose.h"

namespace ar {

struct OneEuroSettings {
    double min_cutoff_hz = 1;            ///< at rest: lower = steadier, slower
    double beta = 5;                     ///< Hz per m/s, or per rad/s: higher = less lag in motion
    double speed_cutoff_hz = 1;          ///< of the speed that the cutoffs follow
    double velocity_min_cutoff_hz = 0.3; ///< of the velocity that predictions use, at rest
    double velocity_beta = 5;            ///< its rise
};

/// The filter's memory for three numbers: a position, or the rotation vector from the pose `value` began with.
struct OneEuroState {
    glm::dvec3 velocity{0};      ///< per second, for predictions
    glm::dvec3 slow_velocity{0}; ///< for the cutoff
    double lag_s = 0;            ///< by which the value is behind a constant motion: tau
};

class OneEuroPose {
public:
    explicit OneEuroPose(OneEuroSettings const& position = {}, OneEuroSettings const& rotation = {});

    void restart(Pose const& pose);
    /// @param dt_s since the input before, > 0
    void step(Pose const& pose, double dt_s);
    /// The filtered pose moved on at constant velocity by `ahead_s`, and by its lag with it.
    Pose moved_on(double ahead_s) const;
    double speed_m_s() const { return glm::length(position_.velocity); }
    double speed_deg_s() const { return glm::degrees(glm::length(rotation_.velocity)); }

private:
    OneEuroSettings position_settings_, rotation_settings_;
    OneEuroState position_, rotation_;
    Pose input_, value_;
};

} // namespace ar
