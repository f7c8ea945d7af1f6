#pragma once
// Runs an AR session in a headset with video pass-through. Each composite is placed in the room where the
// headset's camera was when its frame was taken, and each eye sees it from its predicted pose at display time.

#include "viewer/camera_view/pass_through.h"
#include "viewer/devices/xr/session.h"

#include <deque>

namespace viewer {

/// The head's poses, as predicted by the runtime for its frames.
class HeadPath {
public:
    /// @param steady_s  increasing
    void add(double steady_s, gi::RigidPose const& room_from_head);
    /// Interpolated pose; outside the known range, the first or last one; nothing before the first was added.
    std::optional<gi::RigidPose> at(double steady_s) const;

private:
    static constexpr double kKept_s = 2;
    std::deque<ar::TimedPose> poses_;
};

struct ArHmdOptions {
    PassThroughOptions pass_through;
    HmdOptions headset;
    /// Folder for the last pictures of both eyes, left.png and right.png; empty = none.
    std::filesystem::path eyes;
};

struct ArHmdSummary {
    PassThroughCounts frames;
    std::uint64_t shown = 0;  ///< stereo pictures submitted to the runtime
    std::uint64_t fresh = 0;  ///< of these, with a new composite
    std::uint64_t blind = 0;  ///< without a head pose: the picture is fixed to the head
    ar::Spread first_seen_ms; ///< time from capture to the predicted first display, per composite
    ar::Spread age_ms;        ///< age of the composite, over all pictures shown
    std::vector<std::string> phases;
    std::string headset;
    int losses = 0;
};

/// Runs until the frames end, or `stop`.  @throws gi::InputError no runtime,
/// no headset, or the session cannot be run
/// @param summary  is filled even if an exception is thrown
void run_ar_in_hmd(ar::Session const& session, ArHmdOptions const& options, gi::StopRequest const& stop,
                   gi::Report& report, ArHmdSummary& summary);

std::string describe(ArHmdSummary const& summary);

} // namespace viewer
