#pragma once
// Walking: an upright body on the floor of a world.

#include "viewer/engine/live/ground.h"

namespace viewer {

/// Limits of a walking person, m.
struct WalkLimits {
    double climb_m = 0.4;   ///< highest step that is climbed
    double drop_m = 1;      ///< deepest drop that is taken
    double radius_m = 0.25; ///< of the body: distance kept from walls
};

/// A standing body.
struct WalkStance {
    gi::dvec3 foot{0}; ///< on the floor, m, absolute
    double eye_m = 0;  ///< height of the eyes above it
};

/// Stance on the floor below a point, however far down; none if there is no floor. Under a ceiling that is too
/// low, the eyes are 0.1 m below it.
std::optional<WalkStance> stand_below(Ground const& ground, gi::dvec3 eyes, double eye_height_m);

/// Walks a horizontal way in steps of 0.1 m: slides along walls, goes up and down as the limits allow,
/// and stops at an edge that exceeds them or where the ceiling is lower than the body.
/// Walls lower than climb_m count as floor.
WalkStance walk(Ground const& ground, WalkStance const& from, gi::dvec3 way_m, WalkLimits const& limits = {});

} // namespace viewer
