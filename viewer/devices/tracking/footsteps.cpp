#include "viewer/devices/tracking/footsteps.h"

#include "gi/core/pose.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace viewer {
namespace {

constexpr double kStillStray = 0.3;                   // factor on the allowed stray of a user who stands still
constexpr double kStill_m_s = 0.05, kSmooth_s = 0.1;  // speed that counts as standing; smoothing of the velocity
constexpr double kLongestLead_m = 0.12;               // ahead of the hips
constexpr double kHalfStride_m = 0.4, kLeast_s = 0.1; // swings are fast enough for strides of this length
constexpr double kMostLift_m = 0.1, kMostPitch_rad = 0.5;

double smooth(double t) { return t * t * (3 - 2 * t); }

double turn_from(double from_rad, double to_rad)
{
    return std::remainder(to_rad - from_rad, 2 * std::numbers::pi);
}

double swing_s(double speed_m_s)
{
    return std::clamp(kHalfStride_m / std::max(speed_m_s, 1e-9), kLeast_s, Footsteps::kSwing_s);
}

gi::dquat turned(double yaw_rad) { return gi::exp_rotation({0, yaw_rad, 0}); }

double yaw_of(gi::dvec3 forward) { return std::atan2(-forward.x, -forward.z); }

} // namespace

Footsteps::Print Footsteps::moved(Print const& p, gi::dmat4 const& m)
{
    gi::dvec3 const ahead = turned(p.yaw_rad) * gi::dvec3{0, 0, -1};
    return {gi::dvec3(m * glm::dvec4(p.at, 1)), yaw_of(glm::dmat3(m) * ahead)};
}

double Footsteps::stray(Print const& from, Print const& to, bool is_still)
{
    double const far = std::max(glm::distance(from.at, to.at) / kStray_m,
                                std::abs(turn_from(from.yaw_rad, to.yaw_rad)) / kStray_rad);
    return is_still ? far / kStillStray : far;
}

RoomPose Footsteps::swinging(Print const& from, Print const& to, double phase)
{
    gi::dvec3 const way = to.at - from.at;
    double const yaw = from.yaw_rad + smooth(phase) * turn_from(from.yaw_rad, to.yaw_rad);
    double const ahead = glm::dot(way, turned(yaw) * gi::dvec3{0, 0, -1});
    gi::dvec3 at = from.at + smooth(phase) * way;
    at.y = std::min(kMostLift_m, 0.03 + 0.2 * glm::length(way)) * std::sin(std::numbers::pi * phase);
    // When stepping forward, the heel lifts first and lands first.
    double const pitch =
        -kMostPitch_rad * std::clamp(ahead / kHalfStride_m, 0.0, 1.0) * std::sin(2 * std::numbers::pi * phase);
    return {at, turned(yaw) * gi::exp_rotation({phase < 0.5 ? pitch : 0.5 * pitch, 0, 0})};
}

void Footsteps::stand_at(Foot& foot, Print const& in_room, gi::dmat4 const& world_from_room) const
{
    foot = {moved(in_room, world_from_room), false, 0};
}

void Footsteps::step(Tracked& body, gi::dmat4 const& world_from_room, double seconds)
{
    if (!body.head) {
        begun_ = false;
        return;
    }
    gi::dmat4 const room_from_world = glm::inverse(world_from_room);
    auto const on_floor = [&](gi::dvec3 world) {
        gi::dvec3 const p(room_from_world * glm::dvec4(world, 1));
        return gi::dvec3{p.x, 0, p.z};
    };
    gi::dvec3 middle = *body.head * stance_.head_joint_in_head;
    middle.y = 0;
    double const yaw = yaw_of(gi::heading_of(body.head->rotation) * gi::dvec3{0, 0, -1});
    gi::dvec3 const by = begun_ ? middle - on_floor(last_) : gi::dvec3{0};
    bool anew = !begun_ || glm::length(by) > kJump_m;
    begun_ = true;
    last_ = world_from_room * glm::dvec4(middle, 1);
    if (anew) velocity_ = {};
    if (!anew && seconds > 0) {
        velocity_ += -std::expm1(-seconds / kSmooth_s) * (by / seconds - velocity_);
        still_s_ = glm::length(by) < kStill_m_s * seconds ? still_s_ + seconds : 0;
    }
    double const speed = glm::length(velocity_), swing = swing_s(speed);
    anew = anew || speed > kGlide_m_s;
    bool const is_still = still_s_ > kStill_s;
    gi::dvec3 lead = 0.5 * swing * velocity_;
    if (glm::length(lead) > kLongestLead_m) lead *= kLongestLead_m / glm::length(lead);

    std::array<std::optional<RoomPose>*, 2> const poses{&body.left_foot, &body.right_foot};
    std::array<gi::dvec3, 2> const below{stance_.left_foot, stance_.right_foot};
    std::array<Print, 2> stands, goes;
    std::array<bool, 2> const is_tracked{body.left_foot.has_value(), body.right_foot.has_value()};
    for (std::size_t f = 0; f < 2; ++f) {
        goes[f] = {middle + turned(yaw) * below[f] + (is_still ? gi::dvec3{0} : lead), yaw};
        if (is_tracked[f]) {
            gi::dvec3 const p = (*poses[f])->position;
            stand_at(feet_[f],
                     {{p.x, 0, p.z}, yaw_of(gi::heading_of((*poses[f])->rotation) * gi::dvec3{0, 0, -1})},
                     world_from_room);
        } else if (anew) {
            stand_at(feet_[f], {middle + turned(yaw) * below[f], yaw}, world_from_room);
        }
        if (feet_[f].swings) feet_[f].phase += std::max(0.0, seconds) / swing;
        if (feet_[f].phase >= 1) stand_at(feet_[f], goes[f], world_from_room);
        stands[f] = moved(feet_[f].stands, room_from_world);
        stands[f].at.y = 0;
    }
    if (!feet_[0].swings && !feet_[1].swings) {
        auto const far = [&](std::size_t f) { return is_tracked[f] ? 0 : stray(stands[f], goes[f], is_still); };
        std::size_t const next = far(0) >= far(1) ? 0 : 1;
        feet_[next].swings = far(next) > 1;
    }
    for (std::size_t f = 0; f < 2; ++f)
        if (!is_tracked[f])
            *poses[f] = feet_[f].swings ? swinging(stands[f], goes[f], feet_[f].phase)
                                        : RoomPose{stands[f].at, turned(stands[f].yaw_rad)};
}

} // namespace viewer
