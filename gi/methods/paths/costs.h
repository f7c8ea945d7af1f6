#pragma once
// Rough costs of the parts of a picture, in seconds on one core, from the machine and scenes of docs/performance.md. The
// plan compares them; they are constants, so that the same call always gives the same plan.

#include "gi/scene/model/world.h"

#include <algorithm>
#include <cmath>

namespace gi {

struct Costs {
    double triangles, layers; ///< numbers of triangles, and of layers per texel
    double direct, bounce;    ///< per pixel, including look-ups
    double ray, shadow_ray;   ///< per exact, incoherent ray
    double bvh;               ///< building it

    /// @param layers_each  mean number of layers per non-empty texel, see HitBuffer
    Costs(World const& world, double layers_each)
        : triangles(double(world.triangles.size())), layers(std::max(1.0, layers_each))
    {
        double const shading = view(world).textures.textures.empty() ? 1 : 3;
        direct = 0.15e-6 * shading;
        bounce = 0.13e-6 * shading;
        ray = 1e-9 * (60 + 14 * std::log2(triangles + 1));
        shadow_ray = 0.7 * ray;
        bvh = 4e-7 * triangles;
    }
    double axis(int texels) const { return 2e-9 * triangles + 2e-8 * layers * texels * texels; }
    double map(int texels) const { return 5e-9 * triangles + 5e-8 * layers * texels * texels; }
};

} // namespace gi
