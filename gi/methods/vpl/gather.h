#pragma once
// Light from virtual lights to receivers; the visibility comes from a VisibilityTerm.

#include "gi/methods/vpl/visibility_term.h"

namespace gi {

struct GatherCounts {
    std::uint64_t connections = 0; ///< pairs of surfaces that face each other
    std::uint64_t bounded = 0;     ///< of these, bounded ones; camera paths add the rest

    GatherCounts& operator+=(GatherCounts const& o)
    {
        connections += o.connections;
        bounded += o.bounded;
        return *this;
    }
};

/// Adds the light from virtual lights to radiance[k], for receiver k (fractions: see camera_paths.h).
/// @param bound  1/m^2  @param radiance  one per receiver. Throws Interrupted before any is set.
void gather(ReceiverTile const& tile, std::span<LightVertex const> lights, VisibilityTerm const& term, float bound,
            PassStop const& stop, std::span<vec3> radiance, PathCounts& paths, GatherCounts& counts);

} // namespace gi
