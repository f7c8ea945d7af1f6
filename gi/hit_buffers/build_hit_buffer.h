#pragma once
// Hit buffers built by kernels, in either space, many together: count, scan, fill, sort; then layers that are cut out or beyond
// the limit are removed. The layers equal those of rasterize and fill_hit_buffer bit for bit.

#include "gi/core/error.h"
#include "gi/kernel/launch.h"
#include "gi/kernel/scan.h"
#include "gi/hit_buffers/layer_kernels.h"
#include "gi/raster/raster_shares.h"

#include <span>
#include <utility>

namespace gi {

/// A HitBuffer in a space.
template <Space S>
struct HitBufferOn {
    RasterGrid grid;
    Buffer<std::uint32_t, S> offset; ///< texels + 1
    Buffer<HitLayer, S> layers;
    std::uint64_t lost = 0;

    HitBufferView view() const { return {grid, offset.view(), layers.view()}; }
    std::size_t bytes() const { return offset.size() * sizeof(std::uint32_t) + layers.size() * sizeof(HitLayer); }
};

namespace build_detail {

template <class T, Space S>
Buffer<T, S> zeros(std::size_t n)
{
    Buffer<T, S> b(n);
    fill_bytes(S, b.view().data, 0, n * sizeof(T));
    return b;
}

/// The rasters of buffers, whose layers may not be there yet.
template <Space S>
std::vector<LayerRaster> rasters_of(std::span<HitBufferOn<S>> buffers, std::span<std::uint32_t const> seeds)
{
    std::vector<LayerRaster> rasters;
    std::uint32_t cells = 0;
    for (std::size_t k = 0; k < buffers.size(); ++k) {
        HitBufferOn<S>& b = buffers[k];
        rasters.push_back({b.grid, cells, seeds[k], b.offset.view().data, b.layers.view().data});
        cells += std::uint32_t(b.grid.texels()) + 1;
    }
    return rasters;
}

/// Removes layers and compacts the rest, keeping their order.
template <Space S, class Keep>
void trim(Keep const& keep, std::uint32_t most_layers, std::span<std::uint32_t const> seeds, std::size_t cells,
          std::span<HitBufferOn<S>> buffers)
{
    Buffer<LayerRaster, S> const from = upload<S>(rasters_of<S>(buffers, seeds));
    Buffer<std::uint32_t, S> kept(cells);
    auto lost = zeros<std::uint64_t, S>(buffers.size());
    launch(S, "trim layers", cells, TrimLayers<Keep>{from.view(), keep, most_layers, kept.view(), lost.view()});
    exclusive_scan(S, std::as_const(kept).view(), kept.view());
    std::vector<HitBufferOn<S>> packed;
    for (HitBufferOn<S> const& b : buffers)
        packed.push_back({b.grid, Buffer<std::uint32_t, S>(b.offset.size()), {}});
    Buffer<LayerRaster, S> to = upload<S>(rasters_of<S>(packed, seeds));
    Buffer<std::uint32_t, S> total(buffers.size());
    launch(S, "offsets of layers", cells,
           StartLayers{std::as_const(to).view(), std::as_const(kept).view(), {}, total.view()});
    std::vector<std::uint64_t> const beyond = download(lost);
    std::vector<std::uint32_t> const layers = download(total);
    for (std::size_t k = 0; k < packed.size(); ++k) {
        packed[k].layers = Buffer<HitLayer, S>(layers[k]);
        packed[k].lost = beyond[k];
    }
    to = upload<S>(rasters_of<S>(packed, seeds));
    launch(S, "pack layers", cells, PackLayers{from.view(), std::as_const(to).view()});
    for (std::size_t k = 0; k < packed.size(); ++k) buffers[k] = std::move(packed[k]);
}

/// Builds buffers whose grids are set, all in the same launches.
template <Space S, class Keep>
void build(SoupView const& soup, std::span<HitBufferOn<S>> buffers, std::span<std::uint32_t const> seeds,
           std::uint32_t most_layers, Keep const& keep)
{
    std::size_t cells = 0;
    for (HitBufferOn<S>& b : buffers) {
        b.offset = Buffer<std::uint32_t, S>(b.grid.texels() + 1);
        cells += b.offset.size();
    }
    Buffer<LayerRaster, S> rasters = upload<S>(rasters_of<S>(buffers, seeds));
    RasterShares<S> const shares = raster_shares<S>(soup, std::as_const(rasters).view());
    auto counts = zeros<std::uint32_t, S>(cells);
    auto total = zeros<std::uint64_t, S>(buffers.size());
    launch(S, "count layers", shares.items,
           CountLayers{soup, std::as_const(rasters).view(), shares.view(), counts.view(), total.view()});
    std::vector<std::uint64_t> const layers = download(total);
    for (std::size_t k = 0; k < buffers.size(); ++k) {
        if (layers[k] > 0x7fffffff)
            throw InputError("a hit buffer has more than 2^31 layers", "they are indexed with 32 bits",
                             "lower the resolution");
        buffers[k].layers = Buffer<HitLayer, S>(std::size_t(layers[k]));
    }
    rasters = upload<S>(rasters_of<S>(buffers, seeds));
    exclusive_scan(S, std::as_const(counts).view(), counts.view());
    Buffer<std::uint32_t, S> next(cells);
    launch(S, "offsets of layers", cells,
           StartLayers{std::as_const(rasters).view(), std::as_const(counts).view(), next.view(), {}});
    launch(S, "fill layers", shares.items,
           FillLayers{soup, std::as_const(rasters).view(), shares.view(), next.view()});
    launch(S, "sort layers", cells, SortLayers{std::as_const(rasters).view()});
    if (most_layers > 0 || !std::is_same_v<Keep, KeepAll>) trim<S>(keep, most_layers, seeds, cells, buffers);
}

} // namespace build_detail

/// @param soup  in space S  @param seeds  of cut-outs, one per grid
/// @param most_layers  per texel, see fill_hit_buffer  @param keep  selects the layers that exist, see TrimLayers
/// Throws InputError if there are too many layers for 32-bit indices.
template <Space S, class Keep = KeepAll>
std::vector<HitBufferOn<S>> build_hit_buffers(SoupView const& soup, std::span<RasterGrid const> grids,
                                              std::span<std::uint32_t const> seeds, std::uint32_t most_layers = 0,
                                              Keep const& keep = {})
{
    std::vector<HitBufferOn<S>> buffers;
    for (RasterGrid const& grid : grids) buffers.push_back({grid, {}, {}});
    for_rasters_together(grids, soup.count, [&](std::size_t first, std::size_t last) {
        build_detail::build<S>(soup, std::span(buffers).subspan(first, last - first),
                               seeds.subspan(first, last - first), most_layers, keep);
    });
    return buffers;
}

/// The same for one grid.
template <Space S>
HitBufferOn<S> build_hit_buffer(SoupView const& soup, RasterGrid const& grid, std::uint32_t most_layers = 0)
{
    std::uint32_t const seed = 0;
    return std::move(build_hit_buffers<S>(soup, {&grid, 1}, {&seed, 1}, most_layers).front());
}

} // namespace gi
