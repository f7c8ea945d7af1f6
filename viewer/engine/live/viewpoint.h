#pragma once
// Where the users are and what they look at, and where they will be a moment later.

#include "viewer/protocol/frame_command.h"

#include <deque>

namespace viewer {

/// Last known poses of the users, and their views.
struct Viewpoint {
    double pose_s = 0, display_s = 0; ///< session clock
    double valid_s = -1;              ///< the time that the poses are for, session clock; < 0: pose_s
    gi::dmat4 world_from_room{1};
    Tracked tracked;
    std::vector<Tracked> others;    ///< as in FrameCommand
    std::vector<ViewCommand> views; ///< at full size
    std::uint64_t jump = 0;         ///< Navigation::jump
    double drawn_scale = 0; ///< side of surfaces, over that of the views, that who shows the pictures draws
                            ///< himself; 0 = he does not

    double time_s() const { return valid_s < 0 ? pose_s : valid_s; }
};

bool same_cameras(std::vector<ViewCommand> const& a, std::vector<ViewCommand> const& b);

/// Predicts viewpoints at constant linear and angular velocity, as a picture is seen while the next one is made:
/// by then its viewer has moved on.
class Anticipation {
public:
    /// Farthest prediction, s.
    static constexpr double kFarthest_s = 0.15;
    static constexpr double kForgotten_s = 0.05;

    /// Call for every new viewpoint.
    void see(Viewpoint const& now);
    /// The newest viewpoint, moved on to a time. Unchanged if nothing moves, if it was seen more than
    /// kForgotten_s ago, or if users or views have changed. @param now_s, time_s  session clock
    Viewpoint at(double now_s, double time_s) const;

private:
    bool jumps(Viewpoint const& now) const;

    std::deque<Viewpoint> seen_; ///< the newest last
};

} // namespace viewer
