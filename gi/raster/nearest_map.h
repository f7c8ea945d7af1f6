#pragma once
// The nearest triangle under every texel: G-buffers and shadow maps.

#include "gi/raster/fragments.h"
#include "gi/raster/perspective_grid.h"
#include "gi/raster/triangle_soup.h"

namespace gi {

inline constexpr std::uint32_t kNoPrimitive = 0xffffffffu;

struct alignas(8) NearestTexel {
    float key = -kInf; ///< larger is nearer: 1 / distance (perspective) or -depth (orthographic)
    std::uint32_t primitive = kNoPrimitive; ///< triangle of the world
};

struct NearestMap {
    std::uint32_t width = 0, height = 0;
    std::vector<NearestTexel> texels; ///< row-major
};

/// Triangles first..last - 1, appended with 1 / distance as depth. Chunks outside the view are skipped whole.
void rasterize(TriangleSoup const& soup, std::size_t first, std::size_t last, PerspectiveGrid const& grid,
               Fragments& out);

void clear(NearestMap& map, std::uint32_t width, std::uint32_t height);
/// Keeps the nearer of what is there and each fragment; of two as near, the triangle of smaller number.
/// @param key_sign -1 where small depths are near
void resolve(Fragments const& fragments, float key_sign, NearestMap& map);
/// The same; several threads may at once.
void resolve_shared(Fragments const& fragments, float key_sign, NearestMap& map);

} // namespace gi
