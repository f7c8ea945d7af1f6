#include "gi/hit_buffers/moving_layers.h"

#include "gi/core/error.h"
#include "gi/core/huge_pages.h"

#include <algorithm>
#include <tbb/parallel_for.h>

namespace gi {

void MovingLayers::merge(Source const& source, std::uint32_t cut_seed, AxisPool const& pool, std::size_t a,
                         Axis& out)
{
    BorrowedFragments borrowed;
    Fragments& f = *borrowed;
    thread_local std::vector<std::uint32_t> count; // per texel; zero between calls
    RasterGrid const& grid = pool.grids[a];
    rasterize(source.soup, source.first, source.soup.count, grid, MacroPath::edge_table, f);
    source.cut_outs.remove(f, grid, cut_seed);
    if (count.size() < grid.texels()) count.resize(grid.texels());
    out.texels.clear();
    out.moving = f.count;
    out.lost = 0;
    for (std::size_t k = 0; k < f.count; ++k)
        if (count[f.texel[k]]++ == 0) out.texels.push_back(f.texel[k]);
    // So that neighbours in space are neighbours in memory, as in the static buffer.
    std::ranges::sort(out.texels);
    out.ends.clear();
    auto const stays = [&](std::uint32_t texel) {
        std::uint32_t const* const offset = &pool.offset[pool.first_offset[a] + texel];
        return std::span(pool.layers.data() + pool.first_layer[a] + offset[0], offset[1] - offset[0]);
    };
    std::uint32_t end = 0;
    for (std::uint32_t const t : out.texels) {
        std::uint32_t const fixed = std::uint32_t(stays(t).size());
        // From now on: position of its next layer.
        std::uint32_t const all = fixed + std::exchange(count[t], end + fixed);
        end += all;
        out.ends.push_back(end);
    }
    out.layers.resize(end);
    for (std::size_t k = 0; k < f.count; ++k) out.layers[count[f.texel[k]]++] = {f.depth[k], f.primitive[k]};
    auto const begin_of = [&](std::size_t k) { return k > 0 ? out.ends[k - 1] : 0; };
    for (std::size_t k = 0; k < out.texels.size(); ++k) {
        std::uint32_t const t = out.texels[k];
        std::span const fixed = stays(t);
        HitLayer* const first = out.layers.data() + begin_of(k);
        std::ranges::copy(fixed, first);
        sort_layers(first, out.layers.data() + out.ends[k]);
        count[t] = 0;
    }
    if (source.most_layers == 0) return;
    std::uint32_t kept = 0;
    for (std::size_t k = 0, first = 0; k < out.texels.size(); ++k) {
        std::size_t const n = std::min<std::size_t>(out.ends[k] - first, source.most_layers);
        std::copy_n(out.layers.begin() + std::ptrdiff_t(first), n, out.layers.begin() + kept);
        first = out.ends[k];
        out.ends[k] = kept += std::uint32_t(n);
    }
    out.lost = out.layers.size() - kept;
    out.layers.resize(kept);
}

std::uint64_t MovingLayers::append(Source const& source, std::span<std::uint32_t const> cut_seeds,
                                   std::span<std::uint8_t const> updated, AxisPool& pool)
{
    axes_.resize(pool.size());
    bool changes = static_layers_ == kNone;
    for (std::size_t a = 0; a < axes_.size(); ++a)
        changes |= !axes_[a].current && (updated[a] != 0 || !axes_[a].texels.empty());
    if (!changes) return 0;
    auto const set = [&](std::size_t a, std::size_t k, LayerRange r) {
        pool.ranges[pool.first_offset[a] + axes_[a].texels[k]] = r;
    };
    if (static_layers_ == kNone) {
        static_layers_ = pool.layers.size();
        pool.first_moved = std::uint32_t(static_layers_);
        resize_on_huge_pages(pool.ranges, pool.offset.size());
        tbb::parallel_for(std::size_t(0), pool.size(), [&](std::size_t a) {
            std::uint32_t const* const offset = &pool.offset[pool.first_offset[a]];
            LayerRange* const ranges = &pool.ranges[pool.first_offset[a]];
            for (std::size_t t = 0; t < pool.grids[a].texels(); ++t) ranges[t] = {offset[t], offset[t + 1]};
        });
    } else {
        tbb::parallel_for(std::size_t(0), pool.size(), [&](std::size_t a) {
            std::uint32_t const* const offset = &pool.offset[pool.first_offset[a]];
            for (std::size_t k = 0; k < axes_[a].texels.size(); ++k) {
                std::uint32_t const t = axes_[a].texels[k];
                set(a, k, {offset[t], offset[t + 1]});
            }
        });
    }
    tbb::parallel_for(std::size_t(0), pool.size(), [&](std::size_t a) {
        Axis& axis = axes_[a];
        axis.lost = 0;
        if (axis.current) return;
        axis.current = updated[a] != 0;
        if (axis.current) {
            merge(source, cut_seeds[a], pool, a, axis);
        } else {
            axis.texels.clear();
            axis.layers.clear();
            axis.moving = 0;
        }
    });
    std::vector<std::size_t> first(pool.size() + 1, static_layers_);
    std::uint64_t lost = 0;
    layers_ = 0;
    for (std::size_t a = 0; a < pool.size(); ++a) {
        first[a + 1] = first[a] + axes_[a].layers.size();
        layers_ += axes_[a].moving;
        lost += axes_[a].lost;
    }
    constexpr std::size_t kMost = 0x7fffffff;
    if (first.back() > kMost) {
        moved(); // the pool contains none of the dynamic layers
        throw InputError("the hit buffers have more than 2^31 layers", "they are indexed with 32 bits",
                         "lower the resolution or the number of directions");
    }
    resize_on_huge_pages(pool.layers, first.back());
    tbb::parallel_for(std::size_t(0), pool.size(), [&](std::size_t a) {
        Axis const& axis = axes_[a];
        std::ranges::copy(axis.layers, pool.layers.begin() + std::ptrdiff_t(first[a]));
        auto const at = std::uint32_t(first[a] - pool.first_layer[a]);
        for (std::size_t k = 0; k < axis.texels.size(); ++k)
            set(a, k, {at + (k > 0 ? axis.ends[k - 1] : 0), at + axis.ends[k]});
    });
    return lost;
}

} // namespace gi
