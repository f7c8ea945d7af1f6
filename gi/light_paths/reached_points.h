#pragma once
// Surface points that light reaches, and the space between them: random walks of exact rays
// from the lights and the cameras, or from both sides of all surfaces where those meet nothing.
// In a closed room they are uniform over its area.

#include "gi/render/exact_visibility.h"

#include <vector>

namespace gi {

struct ReachedPoint {
    vec3 position, normal; ///< m; unit, geometric, on the side that was hit
    float clearance;       ///< m, see ShadingPoint
    std::uint32_t triangle;
    float free = kInf; ///< m; length of the flight that left it, kInf = into the open
};

/// Free flight between two surfaces.
struct Flight {
    vec3 from, direction; ///< m; unit
    float length;         ///< m; kInf = into the open
    std::uint32_t leaves; ///< triangle
};

struct Reached {
    std::vector<ReachedPoint> points;
    std::vector<Flight> flights; ///< cosine-distributed, one from each point
};

/// @param walks  from lights, and as many from cameras  @param seed  the same points for the same one
/// @param focus  a small part of the world to which half of the walks from lights afar go; empty = none
Reached reach(World const& world, ExactVisibility const& visibility, std::size_t walks, std::uint64_t seed,
              Bounds const& focus = {});

} // namespace gi
