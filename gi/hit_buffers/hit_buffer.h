#pragma once
// A layered hit buffer: all surfaces under each texel centre of an orthographic view along one axis (Yu 2012,
// sec. 3.4 and 4.3). No layer is dropped, however many a texel has (unless a limit is set).
//
// Layout: the layers of texel t are layers[offset[t]] .. layers[offset[t + 1] - 1], in order of increasing depth
// (equal depths by primitive). offset has texels + 1 entries.

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
    std::uint64_t lost = 0; ///< number of layers beyond the requested limit
};

inline HitBufferView view(HitBuffer const& b) { return {b.grid, b.offset, b.layers}; }

/// Sorts a column; fast for few or nearly sorted layers.
void sort_layers(HitLayer* first, HitLayer* last);

/// Builds a hit buffer: count, scan, fill, sort. Reuses the memory of `out`.
/// @param most_layers  per texel: the first ones along the axis are kept, the others counted; 0 = all
void fill_hit_buffer(Fragments const& fragments, RasterGrid const& grid, std::uint32_t most_layers,
                     HitBuffer& out);

/// Rasterises triangles into a hit buffer on the calling thread.
HitBuffer make_hit_buffer(TriangleSoup const& soup, RasterGrid const& grid,
                          MacroPath macro = MacroPath::edge_table, std::uint32_t most_layers = 0);

} // namespace gi
