#pragma once
// Nearest triangle under every texel, for G-buffers and shadow maps.

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

/// Appends the fragments of triangles first..last - 1, with 1 / distance as depth. Skips chunks outside the view.
void rasterize(TriangleSoup const& soup, std::size_t first, std::size_t last, PerspectiveGrid const& grid,
               Fragments& out);

void clear(NearestMap& map, std::uint32_t width, std::uint32_t height);
/// Merges fragments into the map, keeping the nearest per texel; ties go to the triangle of lower index.
/// @param key_sign -1 if smaller depths are nearer, else 1
void resolve(Fragments const& fragments, float key_sign, NearestMap& map);
/// Same as resolve(), but safe for concurrent calls on one map.
void resolve_shared(Fragments const& fragments, float key_sign, NearestMap& map);

} // namespace gi
