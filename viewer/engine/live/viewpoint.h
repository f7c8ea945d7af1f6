#pragma once
// Where the users are and what they look at, and where they will be a moment later.

#include "viewer/protocol/frame_command.h"

#include <deque>
#include <functional>

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
    /// Farthest prediction, s: by at(), by far_ahead().
    static constexpr double kFarthest_s = 0.15, kFarAhead_s = 1;
    static constexpr double kForgotten_s = 0.05;

    /// Call for every new viewpoint.
    void see(Viewpoint const& now);
    /// The newest viewpoint, moved on to a time. Unchanged if nothing moves, if it was seen more than
    /// kForgotten_s ago, or if users or views have changed. @param now_s, time_s  session clock
    Viewpoint at(double now_s, double time_s) const { return at(now_s, time_s, kFarthest_s); }
    /// The views so much later, at most kFarAhead_s, for pictures whose light is looked up from other poses. Less far where
    /// something stands in the way, where the middle of a view would leave what is seen now, and, as at(), where edges of a view move, as
    /// those of a wall.
    /// @param free_way_m  from a point (m), in a unit direction, at most so far (m)
    std::vector<ViewCommand>
    far_ahead(double now_s, double later_s,
              std::function<double(gi::dvec3, gi::dvec3, double)> const& free_way_m) const;

private:
    Viewpoint at(double now_s, double time_s, double farthest_s) const;
    bool jumps(Viewpoint const& now) const;

    std::deque<Viewpoint> seen_; ///< the newest last
};

} // namespace viewer
