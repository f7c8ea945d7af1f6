#pragma once
// Walking: an upright body on the floor of a world.

#include "gi/render/exact_visibility.h"

#include <memory>
#include <optional>

namespace viewer {

/// Static geometry for walking and collisions, with exact rays against it. It keeps no reference to the world, so
/// that the input thread can trace rays while other threads render.
class Ground {
public:
    /// Copies the static triangles and builds a BVH. Cut-outs by textures are treated as solid.
    explicit Ground(gi::World const& world);

    struct Touch {
        double distance_m = 0;
        gi::dvec3 normal{0}; ///< unit, towards the ray's origin
    };
    /// Nearest surface on a ray. @param from  m, absolute  @param direction  unit  @param reach_m  > 0
    std::optional<Touch> touch(gi::dvec3 from, gi::dvec3 direction, double reach_m) const;

private:
    gi::World still_; ///< positions and triangles only
    std::unique_ptr<gi::ExactVisibility> rays_;
};

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
