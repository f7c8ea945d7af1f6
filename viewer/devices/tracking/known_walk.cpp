#include "viewer/devices/tracking/known_walk.h"

#include "gi/core/pose.h"

#include <cmath>

namespace viewer {

Tracked known_walk(double t)
{
    constexpr double kTurn = 6.283185307179586;
    double const radius = 1.5, along = 1.2 / radius * t;
    double const step = kTurn * 1.9 * t;
    RoomPose body{{radius * std::cos(along), 1.7 + 0.03 * std::sin(step), -radius * std::sin(along)},
                  gi::exp_rotation({0, along, 0})}; // walks along -Z at along = 0
    body.position += body.rotation * gi::dvec3{0.02 * std::sin(0.5 * step), 0, 0};
    double const yaw = glm::radians(40.0) * std::sin(kTurn * 0.35 * t),
                 pitch = glm::radians(10.0) * std::sin(kTurn * 0.2 * t);
    double const roll = glm::radians(2.0) * std::sin(0.5 * step), swing = 0.25 * std::sin(0.5 * step);
    Tracked tracked;
    tracked.head = RoomPose{body.position, body.rotation * gi::exp_rotation({0, yaw, 0}) *
                                               gi::exp_rotation({pitch, 0, 0}) * gi::exp_rotation({0, 0, roll})};
    tracked.left_hand = body * RoomPose{{-0.25, -0.75, -0.1 + swing}};
    tracked.right_hand = body * RoomPose{{0.25, -0.75, -0.1 - swing}};
    return tracked;
}

std::vector<TrackerSample> known_walk_samples(double seconds, double rate_hz)
{
    std::vector<TrackerSample> samples;
    for (std::int64_t i = 0; double(i) / rate_hz <= seconds; ++i) {
        double const t = double(i) / rate_hz;
        Tracked const walk = known_walk(t);
        for (auto const& [body, pose] :
             {std::pair{"head", walk.head}, {"left_hand", walk.left_hand}, {"right_hand", walk.right_hand}}) {
            TrackerSample s;
            s.body = body;
            s.pose = *pose;
            s.measured_s = t;
            s.buttons = 0;
            samples.push_back(std::move(s));
        }
    }
    return samples;
}

} // namespace viewer
