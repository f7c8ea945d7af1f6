#pragma once
// Interface for sources of samples.

#include "viewer/devices/tracking/tracker_sample.h"

namespace viewer {

class Tracker {
public:
    virtual ~Tracker() = default;
    /// Appends the samples received since the last call, oldest first. Does not wait.
    /// @param now_s steady clock; playback sources (files) return the samples due by then
    virtual void poll(double now_s, std::vector<TrackerSample>& samples) = 0;
    virtual TrackerCounts counts() const = 0;
    /// File descriptor to wait on with poll(2); -1 = poll again after a while.
    virtual int descriptor() const { return -1; }
    /// Why nothing is received now, of protocols with connections; empty = all is well.
    virtual std::string fault() const { return {}; }
    /// Description for messages: "osc at 127.0.0.1 port 9000".
    virtual std::string description() const = 0;
};

} // namespace viewer
