#pragma once
// On foot: an upright body on the floor of a world.

#include "viewer/engine/live/ground.h"

namespace viewer {

/// Of people who walk. Lengths m.
struct WalkLimits {
    double climb_m = 0.4;   ///< steps up to this height are climbed
    double drop_m = 1;      ///< no step is taken that leads farther down
    double radius_m = 0.25; ///< of the body: it keeps so far from walls
};

/// A body that stands.
struct WalkStance {
    gi::dvec3 foot{0}; ///< on the floor, m, absolute
    double eye_m = 0;  ///< height of the eyes above it
};

/// The floor below a place, however far; none = nothing is below. Under a ceiling that is too low the eyes are 0.1
/// m below it.
std::optional<WalkStance> stand_below(Ground const& ground, gi::dvec3 eyes, double eye_height_m);

/// One way on the level from there, in steps of 0.1 m: along walls where they are in the way, up and down what
/// the limits allow, to the edge of what they do not; where the ceiling is lower than the body it ends too. Walls
/// lower than climb_m are floor.
WalkStance walk(Ground const& ground, WalkStance const& from, gi::dvec3 way_m, WalkLimits const& limits = {});

} // namespace viewer
