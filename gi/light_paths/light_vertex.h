#pragma once
// A vertex of a light path.

#include "gi/scene/shading/shading_point.h"

namespace gi {

/// A surface point that light has reached.
struct LightVertex {
    vec3 position; ///< m
    vec3 normal;   ///< geometric, unit, on the lit side, the only side from which light leaves
    std::uint32_t triangle;
    float clearance; ///< m, see ShadingPoint
    bool front;      ///< the lit side is the counter-clockwise one
    vec3 power;      ///< power that arrived by this light path, W; includes the correction for shading normals of
                     ///< light travelling from the lights (Veach 1997, eq. 5.19)
    Bsdf bsdf;
    Frame frame;     ///< about the shading normal
    vec3 arrived;    ///< unit, local: direction from which the light came
    bool matt;       ///< purely diffuse: the BSDF is `bsdf.diffuse` / pi
    bool by_delta;   ///< mirrors or glass lie between it and the surface, or light, that it was scattered by last
    bool by_panes_alone; ///< only panes lie between it and the start of its path
    int scatterings; ///< non-delta, before it: 0 = light that comes from its source, or by mirrors and glass alone
    /// Area over which the path's light is spread there, m^2: the reciprocal of the path density, the number of
    /// such paths per m^2 (McGuire and Luebke 2009; Herzog et al. 2007). Mirrors and glass count as flat.
    float footprint;
    std::uint32_t path; ///< number of its path, or index of its start
};

} // namespace gi
