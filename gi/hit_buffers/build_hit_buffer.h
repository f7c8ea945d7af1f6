#pragma once
// Hit buffers built by kernels, in either space: count, scan, fill, sort; then layers that are cut out or beyond
// the limit are removed. The layers equal those of rasterize and fill_hit_buffer bit for bit.

#include "gi/core/error.h"
#include "gi/kernel/launch.h"
#include "gi/kernel/scan.h"
#include "gi/hit_buffers/layer_kernels.h"
#include "gi/raster/raster_shares.h"

namespace gi {

/// A HitBuffer in a space.
template <Space S>
struct HitBufferOn {
    RasterGrid grid;
    Buffer<std::uint32_t, S> offset; ///< texels + 1
    Buffer<HitLayer, S> layers;
    std::uint64_t lost = 0;

    HitBufferView view() const { return {grid, offset.view(), layers.view()}; }
};

namespace build_detail {

template <class T, Space S>
Buffer<T, S> zeros(std::size_t n)
{
    Buffer<T, S> b(n);
    fill_bytes(S, b.view().data, 0, n * sizeof(T));
    return b;
}

/// Removes layers and compacts the rest, keeping their order.
template <Space S, class Keep>
void trim(Keep const& keep, std::uint32_t most_layers, HitBufferOn<S>& b)
{
    std::size_t const texels = b.grid.texels();
    auto kept = zeros<std::uint32_t, S>(texels + 1);
    auto lost = zeros<std::uint64_t, S>(1);
    launch(
        S, "trim layers", texels,
        TrimLayers<Keep>{b.grid, keep, most_layers, b.view().offset, b.layers.view(), kept.view(), lost.view()});
    exclusive_scan(S, std::as_const(kept).view(), kept.view());
    std::uint32_t count = 0;
    copy_bytes(Space::host, &count, S, kept.view().data + texels, sizeof(count));
    Buffer<HitLayer, S> layers(count);
    launch(S, "pack layers", texels,
           PackLayers{b.view().offset, std::as_const(kept).view(), b.view().layers, layers.view()});
    b.offset = std::move(kept);
    b.layers = std::move(layers);
    b.lost = download(lost)[0];
}

} // namespace build_detail

/// @param soup  in space S  @param most_layers  per texel, see fill_hit_buffer
/// @param keep  selects the layers that exist, see TrimLayers
/// Throws InputError if there are too many layers for 32-bit indices.
template <Space S, class Keep = KeepAll>
HitBufferOn<S> build_hit_buffer(SoupView const& soup, RasterGrid const& grid, std::uint32_t most_layers = 0,
                                Keep const& keep = {})
{
    using namespace build_detail;
    std::size_t const texels = grid.texels();
    RasterShares<S> const shares = raster_shares<S>(soup, grid);
    HitBufferOn<S> b;
    b.grid = grid;
    b.offset = zeros<std::uint32_t, S>(texels + 1);
    auto total = zeros<std::uint64_t, S>(1);
    launch(S, "count layers", shares.items, CountLayers{soup, grid, shares.view(), b.offset.view(), total.view()});
    std::uint64_t const layers = download(total)[0];
    if (layers > 0x7fffffff)
        throw InputError("a hit buffer has more than 2^31 layers", "they are indexed with 32 bits",
                         "lower the resolution");
    exclusive_scan(S, b.view().offset, b.offset.view());
    Buffer<std::uint32_t, S> next(texels + 1);
    copy(b.offset, next);
    b.layers = Buffer<HitLayer, S>(std::size_t(layers));
    launch(S, "fill layers", shares.items, FillLayers{soup, grid, shares.view(), next.view(), b.layers.view()});
    launch(S, "sort layers", texels, SortLayers{b.view().offset, b.layers.view()});
    if (most_layers > 0 || !std::is_same_v<Keep, KeepAll>) trim(keep, most_layers, b);
    return b;
}

} // namespace gi
