#pragma once
// Tracks the camera's motion: takes timed pose estimates and returns the pose at any nearby time. All times are
// seconds on the clock of `Frame::captured_s`.

#include "ar/camera/pose.h"
#include "ar/pose/estimate.h"
#include "ar/pose/still_camera.h"
#include "gi/core/one_euro.h"
#include "gi/core/rotation.h"

#include <cstdint>

namespace ar {

enum class CameraMotion { moving, tripod };

struct PoseTrackerSettings {
    CameraMotion motion = CameraMotion::moving;
    gi::OneEuroSettings position{1, 5, 1, 0.3, 16}; ///< betas in Hz per m/s
    gi::OneEuroSettings rotation{1, 4, 1, 0.3, 13}; ///< in Hz per rad/s
    double least_confidence = 0.1;                  ///< estimates below this are ignored
    double predict_s = 0.1; ///< extrapolate at constant velocity for this long, then hold the pose
    double lost_after_s = 0.5;
    /// An estimate farther from the predicted motion than this speed explains (plus the floors) is a jump; it is
    /// accepted once the following ones are near it.
    double jump_m_s = 3, jump_deg_s = 360;
    double jump_least_m = 0.05, jump_least_deg = 5;
    int jump_confirmed_by = 2;
    StillSettings still; ///< of CameraMotion::tripod
};

struct FilteredPose {
    std::optional<gi::RigidPose> world_from_camera; ///< nothing: no estimate yet, or none for `lost_after_s`
    double age_s = 0;                               ///< age of the newest estimate at that time
};

/// What became of an estimate.
enum class Taken {
    taken,
    missed, ///< no pose found, or confidence too low
    late,   ///< not newer than the one before
    jump    ///< refused as a jump
};

struct TrackerCounts {
    std::uint64_t taken = 0;
    std::uint64_t missed = 0; ///< no pose found, or confidence too low
    std::uint64_t late = 0;   ///< ignored, since not newer than the one before
    std::uint64_t jumps_refused = 0;
    std::uint64_t jumps_believed = 0;
    std::uint64_t recoveries = 0; ///< restarts after a loss
    std::uint64_t moves = 0;      ///< of the tripod
};

/// The one-euro filter of a pose (gi/core/one_euro.h), with prediction.
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

private:
    gi::OneEuroSettings position_settings_, rotation_settings_;
    gi::OneEuroPosition position_;
    gi::OneEuroRotation rotation_;
};

class PoseTracker {
public:
    /// @throws gi::InputError settings that are not finite or not positive
    explicit PoseTracker(PoseTrackerSettings const& settings = {});

    Taken add(double captured_s, PoseEstimate const& estimate);
    /// Filtered and predicted pose; for times before the newest estimate, extrapolated backwards equally far.
    FilteredPose at(double time_s) const;
    /// Expected pose at that time, for the argument `last` of `estimate_pose`.
    std::optional<gi::RigidPose> expected(double time_s) const { return at(time_s).world_from_camera; }
    TrackerCounts const& counts() const { return counts_; }
    StillCamera const& still() const { return still_; }

private:
    bool is_far(gi::RigidPose const& a, gi::RigidPose const& b, double dt_s) const;
    bool is_jump(double captured_s, gi::RigidPose const& pose) const;
    void begin(double captured_s, gi::RigidPose const& pose);

    PoseTrackerSettings settings_;
    OneEuroPose filter_;
    StillCamera still_;
    std::optional<double> newest_s_; ///< time of the newest estimate taken
    std::optional<gi::RigidPose> jump_; ///< pose of the last refused estimates
    double jump_s_ = 0;        ///< time of the last of them
    int jump_seen_ = 0;
    TrackerCounts counts_;
};

} // namespace ar
