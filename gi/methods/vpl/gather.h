#pragma once
// Light from virtual lights to receivers: everything but visibility, which a term gives.

#include "gi/methods/vpl/visibility_term.h"

namespace gi {

struct GatherCounts {
    std::uint64_t connections = 0; ///< between surfaces that face each other
    std::uint64_t bounded = 0;     ///< of these, whose rest camera paths bring

    GatherCounts& operator+=(GatherCounts const& o)
    {
        connections += o.connections;
        bounded += o.bounded;
        return *this;
    }
};

/// Adds to radiance[k], of the path of receiver k, what virtual lights bring to it (see camera_paths.h for
/// shares).
/// @param bound 1/m^2  @param radiance as many as receivers
void gather(ReceiverTile const& tile, std::span<VirtualLight const> lights, VisibilityTerm const& term,
            float bound, std::span<vec3> radiance, PathCounts& paths, GatherCounts& counts);

} // namespace gi
