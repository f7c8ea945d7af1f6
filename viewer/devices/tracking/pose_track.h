#pragma once
// The motion of one body: takes samples in any order, and returns the filtered and predicted pose at any time. All
// times are on the samples' clock.
//
// A late sample is inserted at its time and the filter is rerun from there, so that the result does not depend on
// the order of arrival.

#include "gi/core/one_euro.h"
#include "viewer/protocol/frame_command.h"

#include <cstdint>
#include <vector>

namespace viewer {

struct FilterSettings {
    /// False: unfiltered samples; velocities still come from the filter.
    bool enabled = true;
    gi::OneEuroSettings position{1, 5, 1, 0.3, 16}; ///< betas in Hz per m/s
    gi::OneEuroSettings rotation{1, 4, 1, 0.3, 13}; ///< betas in Hz per rad/s

    bool operator==(FilterSettings const&) const = default;
};

struct PredictionSettings {
    double latency_s = 0; ///< from motion to the fastest packet's arrival: sensor, sender and network; measured
    /// Constant velocity up to this time past the newest sample, then fading over the same time.
    double horizon_s = 0.1;
    double lost_after_s = 1; ///< no pose is predicted beyond this time after the newest sample
    double smooth_s = 0.02;  ///< time constant for applying a new sample's correction; 0 = at once
    double recover_s = 0.2;  ///< duration of the transition from a held pose back to the tracked one

    bool operator==(PredictionSettings const&) const = default;
};

/// Gaps between samples longer than this count as dropouts, s: two horizons, at least 0.1.
double dropout_after_s(PredictionSettings const& prediction);

enum class TrackState {
    never,   ///< no sample yet
    tracked, ///< measured, or predicted from a measurement not older than dropout_after_s()
    held,    ///< kept at the last prediction
    lost     ///< without samples for too long: no pose
};

struct TrackedPose {
    TrackState state = TrackState::never;
    std::optional<RoomPose> pose; ///< only if tracked or held
    /// Of the newest sample at the requested time; negative if that time is before the sample.
    double age_s = 0;
};

struct TrackCounts {
    std::uint64_t samples = 0;
    std::uint64_t late = 0;     ///< inserted at their time
    std::uint64_t too_late = 0; ///< older than all kept samples: discarded
    std::uint64_t dropouts = 0; ///< gaps longer than dropout_after_s()

    bool operator==(TrackCounts const&) const = default;
};

class PoseTrack {
public:
    explicit PoseTrack(FilterSettings const& filter = {}, PredictionSettings const& prediction = {});

    /// @param time_s when it was measured
    /// @param now_s when it arrived; used only for the recovery after a dropout
    void add(double time_s, RoomPose const& pose, double now_s);
    TrackedPose at(double time_s) const;
    /// Call when the clock was set: discards all samples and recovers from the `held` pose.
    void restart(std::optional<RoomPose> const& held);
    /// Weight of velocities, 0..1: smaller if the samples' times are uncertain.
    void trust_velocity(double share) { trust_ = share; }
    TrackCounts const& counts() const { return counts_; }

private:
    struct Entry {
        double time_s = 0;
        RoomPose raw;
        gi::OneEuroPosition position;
        gi::OneEuroRotation rotation;
    };

    void filter_from(std::size_t first);
    RoomPose shown(Entry const& entry, double ahead_s) const;
    RoomPose uncorrected(double time_s) const;
    RoomPose corrected(double time_s) const;

    FilterSettings filter_;
    PredictionSettings prediction_;
    std::vector<Entry> entries_;                    ///< by time, at most kMostEntries
    gi::dvec3 correction_m_{0}, correction_rad_{0}; ///< remaining correction at correction_s_
    double correction_s_ = 0;
    std::optional<RoomPose> held_; ///< start of a recovery
    double recovery_start_s_ = 0;
    bool recovery_pending_ = false;
    double trust_ = 1;
    TrackCounts counts_;
};

} // namespace viewer
