#include "ar/pose/tracker.h"

#include "gi/core/error.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace ar {
namespace {

void check(PoseTrackerSettings const& s)
{
    auto const need = [](char const* name, double v) {
        if (v > 0 && std::isfinite(v)) return;
        throw gi::InputError(fmt::format("tracking: {} is {}", name, v), "it must be finite and more than 0",
                             "leave it out for the default");
    };
    for (gi::OneEuroSettings const& f : {s.position, s.rotation}) {
        need("min_cutoff_hz", f.min_cutoff_hz);
        need("speed_cutoff_hz", f.speed_cutoff_hz);
        need("velocity_min_cutoff_hz", f.velocity_min_cutoff_hz);
        need("beta + 1", f.beta + 1);
        need("velocity_beta + 1", f.velocity_beta + 1);
    }
    need("predict_s", s.predict_s);
    need("lost_after_s", s.lost_after_s);
    need("jump_m_s", s.jump_m_s);
    need("jump_deg_s", s.jump_deg_s);
    need("jump_least_m", s.jump_least_m);
    need("jump_least_deg", s.jump_least_deg);
    need("jump_confirmed_by", s.jump_confirmed_by);
    need("limit_sigmas", s.still.limit_sigmas);
    need("keep", double(s.still.keep));
    need("moved_after", s.still.moved_after);
}

} // namespace

PoseTracker::PoseTracker(PoseTrackerSettings const& settings)
    : settings_(settings), filter_(settings.position, settings.rotation), still_(settings.still)
{
    check(settings);
}

bool PoseTracker::is_far(gi::RigidPose const& a, gi::RigidPose const& b, double dt_s) const
{
    return glm::length(a.position - b.position) > settings_.jump_least_m + settings_.jump_m_s * dt_s ||
           angle_between_deg(a.rotation, b.rotation) > settings_.jump_least_deg + settings_.jump_deg_s * dt_s;
}

bool PoseTracker::is_jump(double captured_s, gi::RigidPose const& pose) const
{
    double const dt = captured_s - *newest_s_;
    return is_far(pose, filter_.moved_on(std::min(dt, settings_.predict_s)), dt);
}

void PoseTracker::begin(double captured_s, gi::RigidPose const& pose)
{
    filter_.restart(pose);
    newest_s_ = captured_s;
    jump_.reset();
    jump_seen_ = 0;
}

Taken PoseTracker::add(double captured_s, PoseEstimate const& e)
{
    if (!e.found() || !(e.confidence >= settings_.least_confidence)) {
        ++counts_.missed;
        return Taken::missed;
    }
    if (!std::isfinite(captured_s) || (newest_s_ && captured_s <= *newest_s_)) {
        ++counts_.late;
        return Taken::late;
    }
    gi::RigidPose const& pose = e.world_from_camera;
    if (settings_.motion == CameraMotion::tripod) {
        counts_.moves += still_.add(e) ? 1 : 0;
        newest_s_ = captured_s;
    } else if (!newest_s_ || captured_s - *newest_s_ > settings_.lost_after_s) {
        counts_.recoveries += newest_s_ ? 1 : 0;
        begin(captured_s, pose);
    } else if (is_jump(captured_s, pose)) {
        bool const again = jump_ && captured_s > jump_s_ && !is_far(pose, *jump_, captured_s - jump_s_);
        jump_seen_ = again ? jump_seen_ + 1 : 0;
        jump_ = pose;
        jump_s_ = captured_s;
        if (jump_seen_ < settings_.jump_confirmed_by) {
            ++counts_.jumps_refused;
            return Taken::jump;
        }
        ++counts_.jumps_believed;
        begin(captured_s, pose);
    } else {
        filter_.step(pose, captured_s - *newest_s_);
        newest_s_ = captured_s;
        jump_.reset();
    }
    ++counts_.taken;
    return Taken::taken;
}

FilteredPose PoseTracker::at(double time_s) const
{
    FilteredPose t;
    if (!newest_s_ || !std::isfinite(time_s)) return t;
    t.age_s = time_s - *newest_s_;
    if (settings_.motion == CameraMotion::tripod) {
        // The tripod stands still: if markers are covered for a while, the pose is only less certain, not lost.
        t.world_from_camera = still_.pose()->world_from_camera;
        return t;
    }
    if (t.age_s > settings_.lost_after_s) return t;
    t.world_from_camera = filter_.moved_on(std::clamp(t.age_s, -settings_.predict_s, settings_.predict_s));
    return t;
}

} // namespace ar
