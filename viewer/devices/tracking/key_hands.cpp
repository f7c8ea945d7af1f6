#include "viewer/devices/tracking/key_hands.h"

#include "gi/core/pose.h"

#include <algorithm>

namespace viewer {
namespace {

constexpr double kRise_s = 0.6;

gi::dquat rotation_of(gi::dvec3 x, gi::dvec3 y, gi::dvec3 z)
{
    return glm::normalize(glm::quat_cast(glm::dmat3(x, y, z)));
}

/// Hand pose relative to the head's position and yaw. @param side  -1 left, 1 right
RoomPose hand_at(double side, double risen)
{
    // Hanging: fingers down, palm inwards. Raised: fingers up, palm forward.
    RoomPose const down{{0.25 * side, -0.8, 0.04}, rotation_of({0, 0, side}, {side, 0, 0}, {0, 1, 0})};
    RoomPose const up{{0.3 * side, 0.08, -0.3}, rotation_of({1, 0, 0}, {0, 0, 1}, {0, -1, 0})};
    RoomPose p = between(down, up, risen * risen * (3 - 2 * risen));
    p.position.z -= 0.25 * std::sin(gi::kPi * risen); // path in front of the body
    return p;
}

} // namespace

void KeyHands::step(bool left_rises, bool right_rises, double seconds)
{
    double const by = std::max(0.0, seconds) / kRise_s;
    left_ = std::clamp(left_ + (left_rises ? by : -by), 0.0, 1.0);
    right_ = std::clamp(right_ + (right_rises ? by : -by), 0.0, 1.0);
}

Tracked KeyHands::with_head(RoomPose const& head) const
{
    RoomPose const body{head.position, gi::heading_of(head.rotation)};
    return {head, body * hand_at(-1, left_), body * hand_at(1, right_)};
}

} // namespace viewer
