#pragma once
// Steps of make_radiance_grids(), as kernels for CPU and CUDA.

#include "gi/methods/sh_grid/radiance_grid.h"

namespace gi {

/// The patch and side of each photon.
struct FindPhotonPatches {
    CellsView<BlockVoxels> blocks;
    PatchesView patches;
    View<Photon const> photons;
    View<std::uint64_t> keys;    ///< 2 x patch + side, or 2 x kNoCell: nowhere
    View<std::uint32_t> indices; ///< of the photons

    GI_FN void operator()(std::size_t i) const
    {
        Photon const& photon = photons[i];
        std::uint64_t const patch = patch_at(blocks, patches, photon.position, photon.triangle),
                            side = photon.front ? 0 : 1;
        keys[i] = 2 * std::uint64_t(patch) + (patch != kNoCell ? side : 0);
        indices[i] = std::uint32_t(i);
    }
};

/// The first of the sorted photons of each side of patches.
struct FindFirstPhotons {
    View<std::uint64_t const> keys; ///< sorted
    View<std::uint32_t> firsts;     ///< one per side and one more, which holds the number of photons in patches

    GI_FN void operator()(std::size_t side) const
    {
        std::size_t low = 0, high = keys.size();
        while (low < high) {
            std::size_t const middle = (low + high) / 2;
            if (keys[middle] < side)
                low = middle + 1;
            else
                high = middle;
        }
        firsts[side] = std::uint32_t(low);
    }
};

/// Sums the photons of a cell and of its patches.
struct SumPhotons {
    View<Photon const> photons;
    View<std::uint32_t const> order, firsts;
    View<std::uint32_t const> first_patch; ///< per cell, and one more
    View<CellArea const> areas;
    RadianceBy by;
    View<PatchLight> patches;
    View<CellLight> cells;

    GI_FN void operator()(std::size_t cell) const
    {
        CellLight light;
        light.area = areas[cell];
        for (std::uint32_t side = 2 * first_patch[cell]; side < 2 * first_patch[cell + 1]; ++side) {
            for (std::uint32_t k = firsts[side]; k < firsts[side + 1]; ++k) {
                Photon const& photon = photons[order[k]];
                vec3 const flux = photon.flux;
                patches[side / 2].flux[side % 2] += flux;
                light.flux.add(by == RadianceBy::normal ? photon.normal : photon.direction, flux);
            }
        }
        cells[cell] = light;
    }
};

} // namespace gi
