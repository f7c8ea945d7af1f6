#pragma once
// Light of caustics at the points of ray trees.

#include "gi/light_paths/photon_map.h"
#include "gi/methods/whitted/tree_tracer.h"

namespace gi {

/// Radiance that leaves a point by photons of a map, without what a ray of the glossy lobe brings.
inline vec3 photon_radiance(PhotonMap const& map, TreePoint const& p)
{
    vec3 const all = map.radiance(p.at, p.wo);
    if (!p.glossy_traced || !(max_component(all) > 0)) return all;
    ShadingPoint glossy = p.at;
    glossy.bsdf = glossy_lobe(p.at.bsdf);
    return glm::max(all - map.radiance(glossy, p.wo), vec3{0});
}

/// Adds light that has scattered once to that layer of the points' samples.
inline void add_caustics(PhotonMap const& map, std::span<TreePoint const> points)
{
    for (TreePoint const& p : points)
        layer_of(*p.sample, p.scatterings + 1) += p.throughput * photon_radiance(map, p);
}

} // namespace gi
