#pragma once
// The motion of one body: samples in, in any order; its pose at any time out, filtered and predicted. All times
// are on one clock, that of the samples.
//
// A late sample takes its place among the others and the filter runs again from there, so that the result depends
// on which samples came and not on their order.

#include "gi/core/one_euro.h"
#include "viewer/protocol/frame_command.h"

#include <cstdint>
#include <vector>

namespace viewer {

struct FilterSettings {
    bool enabled = true; ///< false: samples as they are, velocities still from the filter
    gi::OneEuroSettings position{1, 5, 1, 0.3, 16}; ///< betas in Hz per m/s
    gi::OneEuroSettings rotation{1, 4, 1, 0.3, 13}; ///< betas in Hz per rad/s

    bool operator==(FilterSettings const&) const = default;
};

struct PredictionSettings {
    double latency_s = 0;    ///< from the motion to the fastest packet: of sensor, sender and network; measured
    double horizon_s = 0.1;  ///< at constant velocity up to here past the newest sample, fading over as much again
    double lost_after_s = 1; ///< past the newest sample: then there is no pose
    double smooth_s = 0.02;  ///< time constant with which what a new sample corrects is taken over; 0 = at once
    double recover_s = 0.2;  ///< over which the pose moves from where it was held to where it is

    bool operator==(PredictionSettings const&) const = default;
};

/// A gap between samples that is longer counts as a dropout, s: two horizons, at least 0.1.
double dropout_after_s(PredictionSettings const& prediction);

enum class TrackState {
    never,   ///< no sample yet
    tracked, ///< measured, or predicted from a measurement not older than dropout_after_s()
    held,    ///< where it was last predicted
    lost     ///< for too long: no pose
};

struct TrackedPose {
    TrackState state = TrackState::never;
    std::optional<RoomPose> pose; ///< of tracked and held
    double age_s = 0;             ///< of the newest sample at that time; negative: that time is past
};

struct TrackCounts {
    std::uint64_t samples = 0;
    std::uint64_t late = 0;     ///< put in their place
    std::uint64_t too_late = 0; ///< older than all that is kept: of no use
    std::uint64_t dropouts = 0; ///< gaps longer than dropout_after_s()

    bool operator==(TrackCounts const&) const = default;
};

class PoseTrack {
public:
    explicit PoseTrack(FilterSettings const& filter = {}, PredictionSettings const& prediction = {});

    /// @param time_s when it was measured
    /// @param now_s when it came; only for the recovery after a dropout
    void add(double time_s, RoomPose const& pose, double now_s);
    TrackedPose at(double time_s) const;
    /// The clock was set: forgets all samples; `held` is recovered from.
    void restart(std::optional<RoomPose> const& held);
    /// How far velocities are believed, 0..1: less where the times of samples are uncertain.
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
    gi::dvec3 correction_m_{0}, correction_rad_{0}; ///< still to be taken over at correction_s_
    double correction_s_ = 0;
    std::optional<RoomPose> held_; ///< where a recovery begins
    double recovery_start_s_ = 0;
    bool recovery_pending_ = false;
    double trust_ = 1;
    TrackCounts counts_;
};

} // namespace viewer
