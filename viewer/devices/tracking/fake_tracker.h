#pragma once
// Nobody's tracker: a person who stands still, for trying out displays that expect one.

#include "viewer/devices/tracking/tracker.h"

namespace viewer {

/// Gives bodies "head" (at 0, 1.7, 0, looking along -Z), "left_hand" and "right_hand" as often as it is polled.
class FakeTracker : public Tracker {
public:
    void poll(double now_s, std::vector<TrackerSample>& samples) override;
    TrackerCounts counts() const override { return counts_; }
    std::string description() const override { return "a person who stands still"; }

private:
    TrackerCounts counts_;
};

} // namespace viewer
