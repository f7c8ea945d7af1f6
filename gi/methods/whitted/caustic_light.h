#pragma once
// Light of caustics at the points of ray trees.

#include "gi/light_paths/photon_map.h"
#include "gi/methods/whitted/tree_tracer.h"

namespace gi {

/// Adds light that has scattered once to that layer of the points' samples.
inline void add_caustics(PhotonMap const& map, std::span<TreePoint const> points)
{
    for (TreePoint const& p : points)
        layer_of(*p.sample, p.scatterings + 1) += p.throughput * map.radiance(p.at, p.wo, p.glossy_traced);
}

} // namespace gi
