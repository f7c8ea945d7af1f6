#pragma once
// Virtual point lights (Keller 1997): the surfaces that light paths meet send on what reached them. All the
// visibility on the way from the lamps is exact.

#include "gi/render/exact_visibility.h"
#include "gi/render/path_sample.h"
#include "gi/scene/shading/shading_point.h"

#include <vector>

namespace gi {

struct VirtualLight {
    vec3 position; ///< m
    vec3 normal;   ///< geometric, unit, towards the side that was lit: light leaves on that side alone
    std::uint32_t triangle;
    float clearance; ///< m, see ShadingPoint
    bool front;      ///< that side is the counter-clockwise one
    vec3 power;      ///< W: what arrived, of this light path's share of all; with the cosines of shading normals
                     ///< that light has which travels from lamps (Veach 1997, eq. 5.19)
    Bsdf bsdf;
    Frame frame;  ///< about the shading normal
    vec3 arrived; ///< unit, local: towards where the light came from
    bool matt;    ///< nothing but a diffuse base: the BSDF is `bsdf.diffuse` / pi
};

struct LightPaths {
    std::uint32_t count = 256; ///< >= 1
    int bounces = 1;           ///< indirect ones of the picture; a virtual light is the first of them
    std::uint64_t seed = 0;
    std::uint32_t pass = 0;
};

/// In the order of the paths, whatever the number of threads. Empty where nothing shines or bounces == 0.
std::vector<VirtualLight> trace_light_paths(WorldView const& world, Bounds const& bounds,
                                            ExactVisibility const& visibility, LightPaths const& settings,
                                            PathCounts& counts);

} // namespace gi
