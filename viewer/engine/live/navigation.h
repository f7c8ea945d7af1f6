#pragma once
// How a user moves through the world: where the room (or, without one, the head) is. Three ways: fly, along the
// view; walk, with the eyes at their height above the floor (walking.h), or, where no floor is below, on the
// level; orbit, round a point. Speeds are per second, so that motion does not depend on the rate of frames.

#include "viewer/engine/live/walking.h"

namespace viewer {

enum class NavigationMode { fly, walk, orbit };
char const* name_of(NavigationMode mode);

/// What is pressed and was moved since the last step; axes from -1 to 1.
struct NavigationInput {
    double right = 0, up = 0, forward = 0;      ///< of the speed
    double turn_right_rad = 0, turn_up_rad = 0; ///< since the last step
    double closer = 0;                          ///< of scroll wheels: steps
    bool fast = false, slow = false;            ///< 4 times, a quarter
};

class Navigation {
public:
    /// @param camera  to start at  @param speed_m_s  at normal pace  @param pivot  what orbit goes round
    Navigation(gi::dmat4 const& world_from_camera, double speed_m_s, gi::dvec3 pivot);

    void set_mode(NavigationMode mode);
    NavigationMode mode() const { return mode_; }
    void set_pivot(gi::dvec3 pivot) { pivot_ = pivot; }
    /// What is walked on; null = nothing is known of it, walking stays on the level.
    void set_ground(std::shared_ptr<Ground const> ground);
    /// Of the eyes above the floor when walking, m; > 0.
    void set_eye_height(double m) { eye_height_m_ = m; }
    /// Elsewhere at once, at any height; a step on foot leads back to the floor. Tilt about the view's axis is
    /// taken off.
    void go_to(gi::dmat4 const& world_from_camera);
    /// @param seconds  since the last step; long pauses count as a tenth
    void step(NavigationInput const& input, double seconds);

    gi::dvec3 position() const { return position_; }
    /// Rigid, upright.
    gi::dmat4 world_from_camera() const;
    /// Only what turns about the vertical: for rooms, whose floor stays level.
    gi::dmat4 world_from_room() const;

private:
    void walk_by(gi::dvec3 way_m, double seconds);

    gi::dvec3 position_{0}, pivot_{0};
    double yaw_rad_ = 0, pitch_rad_ = 0; ///< 0 = -Z; positive = left, up
    double speed_m_s_ = 1;
    NavigationMode mode_ = NavigationMode::fly;
    std::shared_ptr<Ground const> ground_;
    std::optional<WalkStance> standing_; ///< while walking, from the first step on
    double eye_height_m_ = 1.6;
};

} // namespace viewer
