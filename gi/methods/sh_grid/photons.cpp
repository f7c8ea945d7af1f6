#include "gi/methods/sh_grid/photons.h"

#include "gi/core/rng.h"
#include "gi/kernel/launch.h"
#include "gi/kernel/sort.h"
#include "gi/methods/sh_grid/photon_kernels.h"

#include <tbb/parallel_for.h>

namespace gi {

void ReachedSides::add(std::span<LightVertex const> vertices)
{
    for (LightVertex const& v : vertices) {
        glm::ivec3 const cell = frame.at(v.position);
        if (frame.holds(cell)) of_cell[frame.index(cell)] |= std::uint16_t(1u << side_index(v.normal, v.front));
    }
}

ReachedSides& ReachedSides::operator|=(ReachedSides const& o)
{
    for (std::size_t k = 0; k < of_cell.size(); ++k) of_cell[k] |= o.of_cell[k];
    return *this;
}

void move_photons(WorldView const& world, std::size_t first_moving, std::span<ReflectedPhoton> photons)
{
    tbb::parallel_for(std::size_t(0), photons.size(), [&](std::size_t i) {
        ReflectedPhoton& p = photons[i];
        if (p.triangle < first_moving) return;
        Surface const& s = world.surfaces[p.triangle];
        vec3 const across = glm::cross(s.edge1, s.edge2);
        float const length = glm::length(across);
        p.position = s.corner + p.weights.x * s.edge1 + p.weights.y * s.edge2;
        if (length > 0) p.normal = across * ((p.front ? 1.0f : -1.0f) / length);
    });
}

SortedPhotons sort_photons(SparseCells<BlockVoxels> const& blocks, Patches const& patches,
                           std::span<ReflectedPhoton const> photons)
{
    std::size_t const n = photons.size(), sides = 2 * patches.count();
    SortedPhotons out{std::vector<std::uint32_t>(n), std::vector<std::uint32_t>(sides + 1)};
    std::vector<std::uint64_t> keys(n), scratch_keys(n);
    std::vector<std::uint32_t> scratch_order(n);
    View<ReflectedPhoton const> const all{photons.data(), n};
    launch(Space::host, "find photon patches", n,
           FindPhotonPatches{blocks.view(), patches.view(), all, keys, out.order});
    sort_pairs(Space::host, keys, out.order, scratch_keys, scratch_order);
    launch(Space::host, "find first photons", sides + 1, FindFirstPhotons{keys, out.firsts});
    return out;
}

void reflect_photons(WorldView const& world, std::span<LightVertex const> vertices, std::uint64_t seed,
                     std::vector<ReflectedPhoton>& out)
{
    std::vector<ReflectedPhoton> photons(vertices.size());
    tbb::parallel_for(std::size_t(0), vertices.size(), [&](std::size_t i) {
        LightVertex const& v = vertices[i];
        Pcg32 rng = Pcg32::for_path(seed ^ 0x9403, std::uint32_t(i), 0);
        // Delta lobes are followed by the light paths themselves.
        float const u_lobe = rng.uniform();
        BsdfSample const s = sample(v.bsdf, v.arrived, v.front, u_lobe, rng.uniform2());
        vec3 const direction = v.frame.to_world(s.wi);
        bool const leaves = !s.delta && s.wi.z > 0 && glm::dot(direction, v.normal) > 0;
        photons[i] = {v.position,
                      v.normal,
                      leaves ? direction : v.normal,
                      leaves ? v.power * s.weight : vec3{0},
                      v.triangle,
                      v.front,
                      barycentric_at(world.surfaces[v.triangle], v.position)};
    });
    for (ReflectedPhoton const& p : photons)
        if (max_component(p.flux) > 0 && all_finite(p.flux)) out.push_back(p);
}

} // namespace gi
