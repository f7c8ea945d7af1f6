#pragma once
// The trackers of a display at work: where the heads of its users are expected to be when a frame is seen.

#include "viewer/devices/tracking/tracker_hub.h"
#include "viewer/devices/xr/session.h"
#include "viewer/displays/display.h"

namespace viewer {

class UserTracking {
public:
    /// Binds sockets, opens files. Throws InputError.
    explicit UserTracking(Display const& display);

    /// @param steady_s  std::chrono::steady_clock: when the frame will be seen
    /// @return per user; empty = not tracked
    std::vector<std::optional<RoomPose>> heads(double steady_s);
    /// Head, hands and feet of a user, for avatars and recordings.
    Tracked bodies(std::size_t user, double steady_s);
    /// Age of the newest packet of the first user's tracker, ms; none without a tracker.
    std::optional<double> age_ms(double steady_s) const;
    /// Packets, losses, latencies, by tracker.
    nlohmann::json stats(double steady_s) const;

private:
    struct Source {
        std::unique_ptr<HmdSession> headset; ///< poses only; else
        std::size_t in_hub = 0;
    };
    Tracked of(Source& source, double steady_s) const;

    Display const& display_;
    std::unique_ptr<TrackerHub> hub_; ///< of all but headsets; null where there are none
    std::vector<Source> sources_;     ///< per tracker of the display
};

} // namespace viewer
