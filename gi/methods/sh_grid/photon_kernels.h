#pragma once
// Steps of sort_photons(), as kernels for CPU and CUDA.

#include "gi/methods/sh_grid/photons.h"

namespace gi {

/// The patch and side of each photon.
struct FindPhotonPatches {
    CellsView<BlockVoxels> blocks;
    PatchesView patches;
    View<ReflectedPhoton const> photons;
    View<std::uint64_t> keys;    ///< 2 x patch + side, or 2 x kNoCell: nowhere
    View<std::uint32_t> indices; ///< of the photons

    GI_FN void operator()(std::size_t i) const
    {
        ReflectedPhoton const& photon = photons[i];
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

} // namespace gi
