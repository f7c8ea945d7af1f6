#pragma once
// Chooses how many stored axes are updated per frame for dynamic geometry, when the schedule is auto.
//
// With the schedule stored, dynamic geometry is redrawn in every frame for every axis. This cost does not depend
// on the number of paths and pixels, and exceeds their cost if much moves. Updating only some axes, different ones
// in every frame (AxisSet::update_some_axes), reduces it in proportion and adds a little noise, which temporal
// reuse averages; nothing is rebuilt, and no reused light is lost. The rule comes from measurements:
// docs/decisions/schedules.md.
//
// - All axes, or 32 per bounce, if their update takes at most 0.2 of the time between frames; else 16 if it takes
//   at most 0.35; else 8.
// - Go down if the smallest of the last three measurements exceeds the limit, or at once if the update takes more
//   than half of the time between frames.
// - Go up one step after eight successive frames in which the next level would take less than 0.6 of its limit.
// - If nothing moves, go up one step per frame, up to all: updating costs nothing then, and the picture converges
//   as with all axes. When something moves again, the earlier level is restored.

#include "gi/render/frame_renderer.h"

#include <deque>
#include <string>

namespace viewer {

class UpdateGovernor {
public:
    /// Measurements of one frame.
    struct Frame {
        gi::DynamicUpdate dynamic_update;
        bool moved = false;  ///< something in the scene moved
        double rate_hz = 20; ///< target frame rate
    };
    void measured(Frame const& frame);
    /// Axes per bounce to update in the next frame, 0 = all. @param may_move  something in the scene may move, as
    /// far as is known before the frame
    int next(bool may_move);

    /// Share of the time between frames that updating all axes would take; 0 = not known yet.
    double share_of_all() const;

private:
    double share(std::size_t level) const;

    std::deque<double> axis_s_;         ///< update time per axis in the last frames in which something moved
    double frame_s_ = 0;                ///< time between frames
    gi::DynamicUpdate dynamic_update_;  ///< of the last frame in which something moved
    std::size_t level_ = 0, shown_ = 0; ///< level while something moves; level of the next frame
    int calm_ = 0, quiet_ = 0;          ///< successive frames with time for the next level; in which nothing moved
    bool may_move_ = true;              ///< in the current frame
};

/// A sentence that names the schedule in use and why; empty if no axes are stored.
/// @param updated  the frame's setting `updated_axes`
std::string schedule_sentence(std::string const& schedule, int updated, int stored, double share_of_all);

} // namespace viewer
