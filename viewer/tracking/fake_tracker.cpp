#include "viewer/tracking/fake_tracker.h"

#include "viewer/tracking/pose_math.h"

#include <algorithm>

namespace viewer {
namespace {

constexpr double kReach = 0.8, kMostPitch = 1.5533; // m, rad
constexpr double kLongestStep = 0.25;               // s; a program that was stopped must not jump

gi::dvec3 limited(gi::dvec3 v, double most)
{
    double const length = glm::length(v);
    return length > most ? v * (most / length) : v;
}

} // namespace

FakeBody step(FakeBody const& body, FakeInput const& in, double dt_s, FakeSpeeds const& speeds)
{
    FakeBody b = body;
    double const dt = std::clamp(dt_s, 0.0, kLongestStep);
    b.yaw_rad += in.yaw_rad;
    b.pitch_rad = std::clamp(b.pitch_rad + in.pitch_rad, -kMostPitch, kMostPitch);
    gi::dquat const heading = exp_rotation({0, b.yaw_rad, 0});
    b.head += heading * limited({in.right, in.up, -in.forward}, 1) * (speeds.head_m_s * dt);
    b.head.y = std::clamp(b.head.y, 0.2, 3.0);
    auto const move = [&](gi::dvec3 hand, gi::dvec3 by) {
        return limited(hand + limited({by.x, by.y, -by.z}, 1) * (speeds.hand_m_s * dt), kReach);
    };
    b.left_hand = move(b.left_hand, in.left_hand);
    b.right_hand = move(b.right_hand, in.right_hand);
    b.left_buttons = in.left_buttons;
    b.right_buttons = in.right_buttons;
    return b;
}

Tracked poses(FakeBody const& b)
{
    gi::dquat const heading = exp_rotation({0, b.yaw_rad, 0});
    Tracked t;
    t.head = RoomPose{b.head, heading * exp_rotation({b.pitch_rad, 0, 0})};
    t.left_hand = RoomPose{b.head + heading * b.left_hand, heading};
    t.right_hand = RoomPose{b.head + heading * b.right_hand, heading};
    return t;
}

void FakeTracker::set(FakeInput const& input)
{
    std::lock_guard const lock(mutex_);
    double const yaw = input_.yaw_rad, pitch = input_.pitch_rad;
    input_ = input;
    input_.yaw_rad += yaw; // turns that no step has taken yet are not lost
    input_.pitch_rad += pitch;
}

void FakeTracker::poll(double now_s, std::vector<TrackerSample>& samples)
{
    std::lock_guard const lock(mutex_);
    body_ = step(body_, input_, now_s - last_s_.value_or(now_s));
    input_.yaw_rad = input_.pitch_rad = 0;
    last_s_ = now_s;
    Tracked const t = poses(body_);
    auto const add = [&](char const* name, RoomPose const& pose, std::uint32_t buttons) {
        TrackerSample s;
        s.body = name;
        s.pose = pose;
        s.received_s = now_s;
        s.measured_s = now_s;
        s.buttons = buttons;
        samples.push_back(std::move(s));
        ++counts_.samples;
    };
    add("head", *t.head, 0);
    add("left_hand", *t.left_hand, body_.left_buttons);
    add("right_hand", *t.right_hand, body_.right_buttons);
}

} // namespace viewer
