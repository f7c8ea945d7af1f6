#pragma once
// Simulated tracker of a person standing still, for testing displays that expect a tracker.

#include "viewer/devices/tracking/tracker.h"

namespace viewer {

/// Returns bodies "head" (at 0, 1.7, 0, looking along -Z), "left_hand" and "right_hand" at every poll.
class FakeTracker : public Tracker {
public:
    void poll(double now_s, std::vector<TrackerSample>& samples) override;
    TrackerCounts counts() const override { return counts_; }
    std::string description() const override { return "a simulated person standing still"; }

private:
    TrackerCounts counts_;
};

} // namespace viewer
