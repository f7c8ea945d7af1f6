#pragma once
// Random closed meshes and views of them.

#include "gi/core/rng.h"
#include "gi/raster/grid.h"
#include "tests/support/scenes.h"

#include <array>
#include <map>

namespace gi::test {

inline vec3 random_direction(Pcg32& rng)
{
    float const z = 2 * rng.uniform() - 1, phi = 2 * kPi * rng.uniform(), r = std::sqrt(std::max(0.0f, 1 - z * z));
    return {r * std::cos(phi), r * std::sin(phi), z};
}

/// An icosphere whose vertices are moved about.
inline World random_closed_mesh(Pcg32& rng, int subdivisions, float roughness)
{
    Scene scene;
    add_sphere(scene, vec3{0}, 1, subdivisions, add_material(scene, lambert(vec3{0.5f})), false);
    vec3 const stretch{0.1f + rng.uniform(), 0.1f + rng.uniform(), 0.1f + rng.uniform()};
    std::map<std::array<float, 3>, vec3> moved; // vertices that coincide stay together
    for (vec3& p : scene.meshes[0].positions) {
        auto const [at, fresh] = moved.try_emplace({p.x, p.y, p.z}, vec3{0});
        if (fresh) at->second = stretch * p * (1 + roughness * (rng.uniform() - 0.5f));
        p = at->second;
    }
    return world_of(scene);
}

inline RasterGrid random_grid(World const& world, Pcg32& rng, std::uint32_t resolution)
{
    vec3 const axis = random_direction(rng);
    vec2 const jitter = rng.uniform2();
    return make_grid(world.bounds, axis, resolution, jitter, 2 * kPi * rng.uniform());
}

} // namespace gi::test
