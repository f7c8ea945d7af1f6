#pragma once
// Runs the trackers of a display: predicts the users' head poses for the time when a frame is seen.

#include "viewer/app/wand_input.h"
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
    /// One per tracker of the display with `wand`, in its order.
    std::vector<WandState> wands(double steady_s) const;
    /// Age of the newest packet from the first user's tracker, ms; none without a tracker.
    std::optional<double> age_ms(double steady_s) const;
    /// Packets, losses and latencies per tracker.
    nlohmann::json stats(double steady_s) const;

private:
    struct Source {
        std::unique_ptr<HmdSession> headset; ///< for poses only; null = `in_hub` is used
        std::size_t in_hub = 0;
    };
    Tracked of(Source& source, double steady_s) const;

    Display const& display_;
    std::unique_ptr<TrackerHub> hub_; ///< all trackers except headsets; null if there are none
    std::vector<Source> sources_;     ///< one per tracker of the display
};

} // namespace viewer
