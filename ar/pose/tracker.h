#pragma once
// The camera's motion: estimates with their times in, its pose at any near time out. All times are seconds on one
// clock, that of `Frame::captured_s`.

#include "ar/pose/estimate.h"
#include "ar/pose/one_euro.h"
#include "ar/pose/still_camera.h"

#include <cstdint>

namespace ar {

enum class TrackState {
    lost,      ///< no pose: never seen, or not for `lost_after_s`
    predicted, ///< from the motion: later than the newest estimate by more than a frame
    tracked    ///< measured
};

enum class CameraMotion { moving, tripod };

struct TrackerSettings {
    CameraMotion motion = CameraMotion::moving;
    gi::OneEuroSettings position{1, 5, 1, 0.3, 16}; ///< betas in Hz per m/s
    gi::OneEuroSettings rotation{1, 4, 1, 0.3, 13}; ///< in Hz per rad/s
    double least_confidence = 0.1;                  ///< below it an estimate counts as none
    double fresh_s = 0.05;                          ///< as old an estimate may be for `tracked`
    double predict_s = 0.1; ///< at constant velocity up to here past the newest estimate, then the pose stays
    double lost_after_s = 0.5;
    /// An estimate that is off the motion by more than this speed would explain (plus the floors) is a jump; it
    /// is believed when the next ones are near it.
    double jump_m_s = 3, jump_deg_s = 360;
    double jump_least_m = 0.05, jump_least_deg = 5;
    int jump_confirmed_by = 2;
    StillSettings still; ///< of CameraMotion::tripod
};

struct TrackedPose {
    TrackState state = TrackState::lost;
    std::optional<Pose> world_from_camera; ///< unless lost
    double age_s = 0;                      ///< of the newest estimate at that time
    double confidence = 0; ///< that of the newest estimate; of predicted, falling to 0 at lost_after_s
};

struct TrackerCounts {
    std::uint64_t taken = 0;
    std::uint64_t missed = 0; ///< no pose was found, or with too little confidence
    std::uint64_t late = 0;   ///< not newer than the one before: not taken
    std::uint64_t jumps_refused = 0;
    std::uint64_t jumps_believed = 0;
    std::uint64_t recoveries = 0; ///< begun anew after a loss
    std::uint64_t moves = 0;      ///< of the tripod
};

class PoseTracker {
public:
    /// @throws gi::InputError settings that are not finite or not positive
    explicit PoseTracker(TrackerSettings const& settings = {});

    void add(double captured_s, PoseEstimate const& estimate);
    /// Filtered and predicted; before the newest estimate it goes back along its velocity as far as it predicts.
    TrackedPose at(double time_s) const;
    /// What `estimate_pose` takes as `last` for a frame of that time.
    std::optional<Pose> expected(double time_s) const { return at(time_s).world_from_camera; }
    TrackerCounts const& counts() const { return counts_; }
    StillCamera const& still() const { return still_; }

private:
    bool is_far(Pose const& a, Pose const& b, double dt_s) const;
    bool is_jump(double captured_s, Pose const& pose) const;
    void begin(double captured_s, Pose const& pose);

    TrackerSettings settings_;
    OneEuroPose filter_;
    StillCamera still_;
    std::optional<double> newest_s_; ///< of what was taken
    double confidence_ = 0;
    std::optional<Pose> jump_; ///< where the last estimates were that were not believed
    double jump_s_ = 0;        ///< when the last of them was
    int jump_seen_ = 0;
    TrackerCounts counts_;
};

} // namespace ar
