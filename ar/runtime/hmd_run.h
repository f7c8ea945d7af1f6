#pragma once
// An AR session seen in a headset: video pass-through. Each composite stands in the room where the headset's
// camera was when its frame was taken, and each eye sees it from where it is predicted to be when the display
// shows it.

#include "ar/runtime/pass_through.h"
#include "viewer/devices/xr/session.h"

#include <deque>

namespace viewer {

/// Where the head was: what the runtime predicted for the moments of its frames.
class HeadPath {
public:
    /// @param steady_s  rising
    void add(double steady_s, ar::Pose const& room_from_head);
    /// Between the two next to that moment, else the first or last known; nothing before the first was added.
    std::optional<ar::Pose> at(double steady_s) const;

private:
    static constexpr double kKept_s = 2;
    std::deque<ar::TimedPose> poses_;
};

struct ArHmdOptions {
    PassThroughOptions pass_through;
    HmdOptions headset;
    std::filesystem::path
        eyes; ///< folder for the last pictures of both eyes, left.png and right.png; empty = none
};

struct ArHmdSummary {
    PassThroughCounts frames;
    std::uint64_t shown = 0; ///< pictures of both eyes handed to the runtime
    std::uint64_t fresh = 0; ///< of these, with a composite that was not seen before
    std::uint64_t blind = 0; ///< without a pose of the head: the picture goes with the head
    Spread first_seen_ms;    ///< of composites: from capture to when they are predicted to be seen first
    Spread age_ms;           ///< of all pictures shown: of the composite in them
    std::vector<std::string> phases;
    std::string headset;
    int losses = 0;
};

/// Until the frames end, or `stop`. @throws gi::InputError there is no runtime, no headset; the session cannot be
/// @param summary  holds what there was when it throws, too
void run_ar_in_hmd(ArSession const& session, ArHmdOptions const& options, gi::StopRequest const& stop,
                   gi::Report& report, ArHmdSummary& summary);

std::string describe(ArHmdSummary const& summary);

} // namespace viewer
