#pragma once
// The one-euro filter of a pose (gi/core/one_euro.h), with prediction.

#include "ar/camera/pose.h"
#include "gi/core/one_euro.h"
#include "gi/core/rotation.h"

namespace ar {

class OneEuroPose {
public:
    explicit OneEuroPose(gi::OneEuroSettings const& position = {}, gi::OneEuroSettings const& rotation = {})
        : position_settings_(position), rotation_settings_(rotation)
    {
    }

    void restart(gi::RigidPose const& pose)
    {
        position_ = gi::start(pose.position);
        rotation_ = gi::start(pose.rotation);
    }
    /// @param dt_s since the input before, > 0
    void step(gi::RigidPose const& pose, double dt_s)
    {
        position_ = gi::step(position_settings_, position_, pose.position, dt_s);
        rotation_ = gi::step(rotation_settings_, rotation_, pose.rotation, dt_s);
    }
    /// The filtered pose extrapolated at constant velocity by `ahead_s` and by the lag of the filter.
    gi::RigidPose moved_on(double ahead_s) const
    {
        return {
            position_.value + (ahead_s + position_.lag_s) * position_.velocity,
            glm::normalize(rotation_.value * gi::exp_rotation((ahead_s + rotation_.lag_s) * rotation_.velocity))};
    }
    double speed_m_s() const { return glm::length(position_.velocity); }
    double speed_deg_s() const { return glm::degrees(glm::length(rotation_.velocity)); }

private:
    gi::OneEuroSettings position_settings_, rotation_settings_;
    gi::OneEuroPosition position_;
    gi::OneEuroRotation rotation_;
};

} // namespace ar
