#pragma once
// Where samples come from.

#include "viewer/devices/tracking/tracker_sample.h"

namespace viewer {

class Tracker {
public:
    virtual ~Tracker() = default;
    /// Appends what has come since the last call, oldest first. Does not wait.
    /// @param now_s steady clock; sources that are played (files) give what is due by then
    virtual void poll(double now_s, std::vector<TrackerSample>& samples) = 0;
    virtual TrackerCounts counts() const = 0;
    /// To wait on with poll(2); -1 = look again after a while.
    virtual int descriptor() const { return -1; }
    /// For people: "osc at 127.0.0.1 port 9000".
    virtual std::string description() const = 0;
};

} // namespace viewer
