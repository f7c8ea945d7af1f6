#pragma once
// A user's motion through the world: the pose of the room (or, without one, of the head). Three modes: fly, along
// the view; walk, with the eyes at their height above the floor (walking.h), or horizontally if there is no floor
// below; orbit, around a point. Speeds are per second, so that motion does not depend on the frame rate.

#include "viewer/engine/live/walking.h"

namespace viewer {

enum class NavigationMode { fly, walk, orbit };
char const* name_of(NavigationMode mode);

/// Input since the last step; axes from -1 to 1.
struct NavigationInput {
    double right = 0, up = 0, forward = 0;      ///< as shares of the speed
    double turn_right_rad = 0, turn_up_rad = 0; ///< since the last step
    double closer = 0;                          ///< steps of the scroll wheel
    bool fast = false, slow = false;            ///< 4 times the speed, a quarter of it
};

class Navigation {
public:
    /// @param camera  start pose  @param speed_m_s  normal speed  @param pivot  centre of orbit
    Navigation(gi::dmat4 const& world_from_camera, double speed_m_s, gi::dvec3 pivot);

    void set_mode(NavigationMode mode);
    NavigationMode mode() const { return mode_; }
    void set_pivot(gi::dvec3 pivot) { pivot_ = pivot; }
    /// Sets the geometry to walk on; null = unknown, walking stays horizontal.
    void set_ground(std::shared_ptr<Ground const> ground);
    /// Height of the eyes above the floor when walking, m; > 0.
    void set_eye_height(double m) { eye_height_m_ = m; }
    double eye_height_m() const { return eye_height_m_; }
    /// Jumps to a pose, at any height; the next step while walking leads back to the floor.
    /// Roll about the view axis is removed.
    void go_to(gi::dmat4 const& world_from_camera);
    /// @param seconds  since the last step; at most 0.1 counts
    void step(NavigationInput const& input, double seconds);

    /// A number of its own for each place that was not walked to: the start, and where go_to led.
    std::uint64_t jump() const { return jump_; }
    gi::dvec3 position() const { return position_; }
    /// Rigid, without roll.
    gi::dmat4 world_from_camera() const;
    /// Position and yaw only, so that a room's floor stays level.
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
    std::uint64_t jump_ = 0;
};

} // namespace viewer
