#pragma once
// Keyboard and mouse instead of a tracker: input moves a head and two hands.

#include "viewer/tracking/tracker.h"

#include <mutex>

namespace viewer {

/// What is held down, -1..1 each, and how far the mouse has moved.
struct FakeInput {
    double right = 0, up = 0, forward = 0; ///< head, along its heading
    gi::dvec3 left_hand{0}, right_hand{0}; ///< right, up, forward
    double yaw_rad = 0, pitch_rad = 0;     ///< turn of the head since the last step; left and up are positive
    std::uint32_t left_buttons = 0, right_buttons = 0;
};

/// Where the faked person is. Angles rad, lengths m.
struct FakeBody {
    gi::dvec3 head{0, 1.7, 0};
    double yaw_rad = 0, pitch_rad = 0;
    gi::dvec3 left_hand{-0.25, -0.5, -0.4}, right_hand{0.25, -0.5, -0.4}; ///< from the head, along its heading
    std::uint32_t left_buttons = 0, right_buttons = 0;
};

struct FakeSpeeds {
    double head_m_s = 1, hand_m_s = 0.5;
};

/// Where it is dt later. Pitch stays within +-89 degrees, hands within 0.8 m of the head, the head 0.2 to 3 m
/// above the floor.
FakeBody step(FakeBody const& body, FakeInput const& input, double dt_s, FakeSpeeds const& speeds = {});
Tracked poses(FakeBody const& body);

/// Gives bodies "head", "left_hand" and "right_hand" as often as it is polled.
class FakeTracker : public Tracker {
public:
    /// Input that holds until the next call; from any thread.
    void set(FakeInput const& input);

    void poll(double now_s, std::vector<TrackerSample>& samples) override;
    TrackerCounts counts() const override { return counts_; }
    std::string description() const override { return "keyboard and mouse"; }

private:
    std::mutex mutex_;
    FakeInput input_;
    FakeBody body_;
    std::optional<double> last_s_;
    TrackerCounts counts_;
};

} // namespace viewer
