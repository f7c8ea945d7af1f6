#pragma once
// A step of make_radiance_grids(), as a kernel for CPU and CUDA.

#include "gi/methods/sh_grid/radiance_grid.h"

namespace gi {

/// Sums the photons of a cell and of its patches.
struct SumPhotons {
    View<ReflectedPhoton const> photons;
    View<std::uint32_t const> order, firsts;
    View<std::uint32_t const> first_patch[2]; ///< of fixed and moving patches, per cell, and one more
    View<CellArea const> areas;
    RadianceBy by;
    View<PatchLight> patches;
    View<CellLight> cells;

    GI_FN void operator()(std::size_t cell) const
    {
        CellLight light;
        light.area = areas[cell];
        for (View<std::uint32_t const> const& first : first_patch) {
            if (cell + 1 >= first.size()) continue;
            for (std::uint32_t side = 2 * first[cell]; side < 2 * first[cell + 1]; ++side)
                for (std::uint32_t k = firsts[side]; k < firsts[side + 1]; ++k) {
                    ReflectedPhoton const& photon = photons[order[k]];
                    vec3 const flux = photon.flux;
                    patches[side / 2].flux[side % 2] += flux;
                    light.flux.add(by == RadianceBy::normal ? photon.normal : photon.direction, flux);
                }
        }
        cells[cell] = light;
    }
};

} // namespace gi
