#pragma once
// A layered hit buffer: every surface under every texel centre of an orthographic view along one axis (Yu 2012,
// sec. 3.4 and 4.3). Exact storage: nothing is dropped, however many layers a texel has.
//
// Layout: the layers of texel t are layers[offset[t]] .. layers[offset[t + 1] - 1], by rising depth (equal depths
// by primitive). offset has texels + 1 entries.

#include "gi/raster/deep_raster.h"
#include "gi/raster/hit_layer.h"

namespace gi {

struct HitBufferView {
    RasterGrid grid;
    View<std::uint32_t const> offset;
    View<HitLayer const> layers;
};

struct HitBuffer {
    RasterGrid grid;
    std::vector<std::uint32_t> offset;
    std::vector<HitLayer> layers;
    std::uint64_t lost = 0; ///< layers beyond a limit that was asked for
};

inline HitBufferView view(HitBuffer const& b) { return {b.grid, b.offset, b.layers}; }

/// A column, fast where it has few layers or starts in order.
void sort_layers(HitLayer* first, HitLayer* last);

/// Count, scan, fill, sort. Reuses the memory of `out`.
/// @param most_layers per texel, the nearest along the axis are kept and the others counted; 0 = all
void fill_hit_buffer(Fragments const& fragments, RasterGrid const& grid, std::uint32_t most_layers,
                     HitBuffer& out);

/// From triangles to layers on the calling thread.
HitBuffer make_hit_buffer(TriangleSoup const& soup, RasterGrid const& grid,
                          MacroPath macro = MacroPath::edge_table, std::uint32_t most_layers = 0);

} // namespace gi
