#pragma once
// Kernels that draw distance impostors.

#include "gi/light_paths/impostor_maps.h"
#include "gi/raster/nearest_map.h"

namespace gi {

/// Item = texel of a face, row by row. Turns what the rasteriser drew into an impostor's texels.
struct StoreImpostorFace {
    PerspectiveGrid grid;
    View<NearestTexel const> drawn;
    View<ImpostorTexel> face; ///< in blocks
    bool keep_nearer = false; ///< existing texels stay if they are nearer

    GI_FN void operator()(std::size_t k) const
    {
        auto const n = int(grid.width), i = int(k) % n, j = int(k) / n;
        NearestTexel const texel = drawn[k];
        ImpostorTexel now;
        if (texel.primitive != kNoPrimitive && texel.key > 0) {
            now.distance = glm::length(grid.direction(std::uint32_t(i), std::uint32_t(j))) / texel.key;
            now.triangle = texel.primitive;
        }
        constexpr int kBlock = ImpostorsView::kBlock;
        ImpostorTexel& out = face[std::size_t((j / kBlock * (n / kBlock) + i / kBlock) * kBlock * kBlock +
                                              j % kBlock * kBlock + i % kBlock)];
        if (!keep_nearer || now.distance < out.distance) out = now;
    }
};

/// Item = block.
struct BoundImpostorBlocks {
    View<ImpostorTexel const> texels;
    View<ImpostorBlock> blocks;

    GI_FN void operator()(std::size_t k) const
    {
        constexpr std::size_t kTexels = std::size_t(ImpostorsView::kBlock) * ImpostorsView::kBlock;
        ImpostorBlock out;
        for (std::size_t t = 0; t < kTexels; ++t) {
            float const d = texels[k * kTexels + t].distance;
            out.nearest = glm::min(out.nearest, d);
            out.farthest = glm::max(out.farthest, d);
        }
        blocks[k] = out;
    }
};

} // namespace gi
