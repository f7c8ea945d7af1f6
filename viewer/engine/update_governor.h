#pragma once
// How many of the stored directions follow what moves, where the schedule is left to the viewer.
//
// With the schedule stored, what moves is drawn anew in every frame for every direction: the same cost for any
// number of paths and pixels, and more than all of them where much moves. DynamicUpdate fewer directions, others
// in every frame (AxisSet::follow_some), costs that much less and a little noise, which temporal reuse averages;
// nothing is built anew, and nothing that was reused is lost. The rule is measured:
// docs/results/2026-11-22-schedules.md.
//
// - All, or 32 of each bounce, where they take no more than a fifth of the time between frames; else 16 where they
//   take no more than 0.35 of it; else 8.
// - Fewer when the least of the last three frames says so, or at once where half of a frame's time is used up by
// it.
// - More, one step at a time, when eight frames in succession say that it would take less than 0.6 of that limit.
// - Where nothing moves, one step more in every frame, up to all: what has followed costs nothing then, and the
//   picture converges as with all. When something moves again, as many as before.

#include "gi/render/frame_renderer.h"

#include <deque>
#include <string>

namespace viewer {

class UpdateGovernor {
public:
    /// What a frame tells.
    struct Frame {
        gi::DynamicUpdate dynamic_update;
        bool moved = false;  ///< something in the scene
        double rate_hz = 20; ///< frames that are aimed at
    };
    void measured(Frame const& frame);
    /// Of the next frame. @param may_move  something in the scene does, for all that is known before it
    int next(bool may_move);

    /// Of the time between frames, by all directions; 0 = not known yet.
    double share_of_all() const;

private:
    double share(std::size_t level) const;

    std::deque<double> axis_s_;         ///< of the last frames in which something moved: for one axis
    double frame_s_ = 0;                ///< between frames
    gi::DynamicUpdate dynamic_update_;  ///< of the last of them
    std::size_t level_ = 0, shown_ = 0; ///< where something moves; of the next frame
    int calm_ = 0, quiet_ = 0; ///< frames in succession: that had time for more; in which nothing moved that might
    bool may_move_ = true;     ///< in the frame at hand
};

/// The schedule in use and why, in a sentence. @param followed  as the setting of the frame has it
std::string schedule_sentence(std::string const& schedule, int updated, int stored, double share_of_all);

} // namespace viewer
