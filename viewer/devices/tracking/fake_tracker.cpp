#include "viewer/devices/tracking/fake_tracker.h"

namespace viewer {
namespace {

constexpr gi::dvec3 kStandingHead{0, 1.7, 0}, kStandingLeft{-0.25, -0.5, -0.4}, kStandingRight{0.25, -0.5, -0.4};

} // namespace

void FakeTracker::poll(double now_s, std::vector<TrackerSample>& samples)
{
    auto const add = [&](char const* name, gi::dvec3 position) {
        TrackerSample s;
        s.body = name;
        s.pose = RoomPose{position, {1, 0, 0, 0}};
        s.received_s = now_s;
        s.measured_s = now_s;
        samples.push_back(std::move(s));
        ++counts_.samples;
    };
    add("head", kStandingHead);
    add("left_hand", kStandingHead + kStandingLeft);
    add("right_hand", kStandingHead + kStandingRight);
}

} // namespace viewer
