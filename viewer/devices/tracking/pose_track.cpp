#include "viewer/devices/tracking/pose_track.h"

#include "gi/core/pose.h"

#include <algorithm>
#include <cmath>

namespace viewer {
namespace {

constexpr std::size_t kMostEntries = 64;
constexpr double kSameTime = 0.0005; ///< s; closer samples are one measurement
constexpr double kLongGap = 0.25;    ///< s; velocities across it are meaningless

/// dt up to the horizon, then increasing more slowly, constant from 1.5 horizons.
double faded(double dt, double horizon)
{
    if (dt <= horizon) return dt;
    if (!(horizon > 0)) return 0;
    double const past = std::min(dt - horizon, horizon);
    return horizon + past - past * past / (2 * horizon);
}

} // namespace

double dropout_after_s(PredictionSettings const& p) { return std::max(0.1, 2 * p.horizon_s); }

PoseTrack::PoseTrack(FilterSettings const& filter, PredictionSettings const& prediction)
    : filter_(filter), prediction_(prediction)
{
    entries_.reserve(kMostEntries + 1);
}

void PoseTrack::add(double time_s, RoomPose const& pose, double now_s)
{
    if (!std::isfinite(time_s) || !is_finite(pose)) return;
    ++counts_.samples;
    if (recovery_pending_) {
        recovery_start_s_ = now_s;
        recovery_pending_ = false;
    }
    auto at_place = std::upper_bound(entries_.begin(), entries_.end(), time_s,
                                     [](double t, Entry const& e) { return t < e.time_s; });
    bool const is_newest = at_place == entries_.end();
    if (!is_newest && at_place == entries_.begin() && entries_.size() == kMostEntries) {
        ++counts_.too_late;
        return;
    }
    if (!is_newest) ++counts_.late;
    if (is_newest && !entries_.empty() && time_s - entries_.back().time_s > dropout_after_s(prediction_)) {
        ++counts_.dropouts;
        held_ = corrected(now_s);
        recovery_start_s_ = now_s;
        correction_m_ = correction_rad_ = gi::dvec3{0};
    }
    bool const recovers = held_ && recovery_start_s_ == now_s;
    bool const smooth = !entries_.empty() && prediction_.smooth_s > 0 && !recovers;
    RoomPose const before = smooth ? corrected(now_s) : RoomPose{};
    std::size_t place = std::size_t(at_place - entries_.begin());
    if (place > 0 && time_s - entries_[place - 1].time_s < kSameTime)
        entries_[--place].raw = pose;
    else if (place < entries_.size() && entries_[place].time_s - time_s < kSameTime)
        entries_[place].raw = pose;
    else
        entries_.insert(at_place, {time_s, pose, {}, {}});
    filter_from(place);
    if (entries_.size() > kMostEntries) entries_.erase(entries_.begin());
    if (smooth) {
        RoomPose const after = uncorrected(now_s);
        correction_m_ = before.position - after.position;
        correction_rad_ = gi::log_rotation(glm::inverse(after.rotation) * before.rotation);
        correction_s_ = now_s;
    }
}

void PoseTrack::filter_from(std::size_t first)
{
    for (std::size_t i = first; i < entries_.size(); ++i) {
        Entry& e = entries_[i];
        double const dt = i > 0 ? e.time_s - entries_[i - 1].time_s : kLongGap + 1;
        if (dt > kLongGap) {
            e.position = gi::start(e.raw.position);
            e.rotation = gi::start(e.raw.rotation);
        } else {
            e.position = step(filter_.position, entries_[i - 1].position, e.raw.position, dt);
            e.rotation = step(filter_.rotation, entries_[i - 1].rotation, e.raw.rotation, dt);
        }
    }
}

RoomPose PoseTrack::shown(Entry const& e, double ahead_s) const
{
    // At constant velocity the filter lags behind; predict by this lag too.
    RoomPose const base = filter_.enabled ? RoomPose{e.position.value, e.rotation.value} : e.raw;
    double const position_s = trust_ * (ahead_s + (filter_.enabled ? e.position.lag_s : 0));
    double const rotation_s = trust_ * (ahead_s + (filter_.enabled ? e.rotation.lag_s : 0));
    return {base.position + e.position.velocity * position_s,
            glm::normalize(base.rotation * gi::exp_rotation(e.rotation.velocity * rotation_s))};
}

RoomPose PoseTrack::uncorrected(double time_s) const
{
    Entry const& newest = entries_.back();
    if (time_s >= newest.time_s) return shown(newest, faded(time_s - newest.time_s, prediction_.horizon_s));
    if (time_s <= entries_.front().time_s) return shown(entries_.front(), 0);
    auto const after = std::upper_bound(entries_.begin(), entries_.end(), time_s,
                                        [](double t, Entry const& e) { return t < e.time_s; });
    Entry const &a = *(after - 1), &b = *after;
    return between(shown(a, 0), shown(b, 0), (time_s - a.time_s) / (b.time_s - a.time_s));
}

RoomPose PoseTrack::corrected(double time_s) const
{
    RoomPose pose = uncorrected(time_s);
    if (!(prediction_.smooth_s > 0)) return pose;
    double const left = std::exp(-std::max(0.0, time_s - correction_s_) / prediction_.smooth_s);
    pose.position += left * correction_m_;
    pose.rotation = glm::normalize(pose.rotation * gi::exp_rotation(left * correction_rad_));
    return pose;
}

TrackedPose PoseTrack::at(double time_s) const
{
    TrackedPose result;
    if (entries_.empty()) return result;
    result.age_s = time_s - entries_.back().time_s;
    if (result.age_s > prediction_.lost_after_s) {
        result.state = TrackState::lost;
        return result;
    }
    result.state = result.age_s > dropout_after_s(prediction_) ? TrackState::held : TrackState::tracked;
    result.pose = corrected(time_s);
    if (held_ && prediction_.recover_s > 0) {
        double const t = std::clamp((time_s - recovery_start_s_) / prediction_.recover_s, 0.0, 1.0);
        if (t < 1) result.pose = between(*held_, *result.pose, t * t * (3 - 2 * t));
    }
    return result;
}

void PoseTrack::restart(std::optional<RoomPose> const& held)
{
    entries_.clear();
    correction_m_ = correction_rad_ = gi::dvec3{0};
    held_ = held;
    recovery_pending_ = held.has_value();
}

} // namespace viewer
