#include "gi/methods/sh_grid/photons.h"

#include "gi/core/rng.h"

#include <tbb/parallel_for.h>

namespace gi {

void ReachedSides::add(std::span<VirtualLight const> vertices)
{
    for (VirtualLight const& v : vertices) {
        glm::ivec3 const cell = frame.at(v.position);
        if (frame.holds(cell)) of_cell[frame.index(cell)] |= std::uint16_t(1u << side_index(v.normal, v.front));
    }
}

void reflect_photons(std::span<VirtualLight const> vertices, std::uint64_t seed, std::vector<Photon>& out)
{
    std::vector<Photon> photons(vertices.size());
    tbb::parallel_for(std::size_t(0), vertices.size(), [&](std::size_t i) {
        VirtualLight const& v = vertices[i];
        Pcg32 rng = Pcg32::for_path(seed ^ 0x9403, std::uint32_t(i), 0);
        // Delta lobes are followed by the light paths themselves.
        float const u_lobe = rng.uniform();
        BsdfSample const s = sample(v.bsdf, v.arrived, v.front, u_lobe, rng.uniform2());
        vec3 const direction = v.frame.to_world(s.wi);
        bool const leaves = !s.delta && s.wi.z > 0 && glm::dot(direction, v.normal) > 0;
        photons[i] = {v.position, v.normal, leaves ? direction : v.normal, leaves ? v.power * s.weight : vec3{0},
                      v.triangle, v.front};
    });
    for (Photon const& p : photons)
        if (max_component(p.flux) > 0 && all_finite(p.flux)) out.push_back(p);
}

} // namespace gi
