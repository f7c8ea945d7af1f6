#pragma once
// Splatting of photons in image space (McGuire and Luebke 2009), tiled: which photons' kernels reach into which
// tiles of the screen, as kernels for CPU and CUDA. They rasterise volumes around photons; we bound these by
// rectangles of tiles, and each pixel adds what of its tile's list reaches its surface, so that nothing is
// overdrawn in memory.

#include "gi/core/view.h"
#include "gi/kernel/atomics.h"
#include "gi/light_paths/photon_map.h"

namespace gi {

/// Where points of the world are seen on a screen.
struct ScreenMap {
    static constexpr int kTile = 16; ///< px

    vec3 origin; ///< m
    mat3 to; ///< of a point relative to the origin: (x w, y w, w), or (x, y, depth) if orthographic; x, y in px
    bool orthographic;
    glm::ivec2 size; ///< px

    GI_FN int columns() const { return (size.x + kTile - 1) / kTile; }
    GI_FN int rows() const { return (size.y + kTile - 1) / kTile; }
    /// Pixel on which a point is seen if nothing is in front; -1 = beside the screen.
    GI_FN glm::ivec2 pixel_of(vec3 position) const
    {
        vec3 const p = to * (position - origin);
        if (!orthographic && !(p.z > 0)) return glm::ivec2{-1};
        vec2 const at = orthographic ? vec2(p) : vec2(p) / p.z;
        bool const on = at.x >= 0 && at.y >= 0 && at.x < float(size.x) && at.y < float(size.y);
        return on ? glm::ivec2(at) : glm::ivec2{-1};
    }
    GI_FN std::size_t tile_of(glm::ivec2 pixel) const
    {
        return std::size_t(pixel.y / kTile * columns() + pixel.x / kTile);
    }
};

/// Tiles first to last - 1, in both directions; may be empty.
struct TileRange {
    glm::ivec2 first{0}, last{0};
};

/// Tiles that a sphere is seen on, or more.
GI_FN inline TileRange tiles_of(ScreenMap const& screen, vec3 center, float radius)
{
    vec3 const p = screen.to * (center - screen.origin);
    auto const row_length = [&](int r) {
        return glm::length(vec3{screen.to[0][r], screen.to[1][r], screen.to[2][r]});
    };
    float low[2], high[2];
    float const w = screen.orthographic ? 1 : p.z, dw = screen.orthographic ? 0 : radius * row_length(2);
    if (!(w + dw > 0)) return {};
    for (int axis = 0; axis < 2; ++axis) {
        float const d = radius * row_length(axis), a = p[axis] - d, b = p[axis] + d;
        // About the camera's plane, only the side towards which a sphere lies wholly is a bound.
        bool const near = !(w - dw > 0);
        low[axis] = a >= 0 ? a / (w + dw) : near ? -kInf : a / (w - dw);
        high[axis] = b <= 0 ? b / (w + dw) : near ? kInf : b / (w - dw);
    }
    TileRange out;
    glm::ivec2 const tiles{screen.columns(), screen.rows()};
    for (int axis = 0; axis < 2; ++axis) {
        float const end = float(screen.size[axis]);
        if (!(low[axis] < end) || !(high[axis] >= 0)) return {};
        out.first[axis] = int(glm::max(low[axis], 0.0f)) / ScreenMap::kTile;
        out.last[axis] = glm::min(int(glm::min(high[axis], end)) / ScreenMap::kTile + 1, tiles[axis]);
    }
    return out;
}

/// Item = photon. Counts it in each of its tiles.
struct CountTiles {
    ScreenMap screen;
    View<PhotonKernel const> kernels;
    View<std::uint32_t> counts; ///< per tile

    GI_FN void operator()(std::size_t i) const
    {
        TileRange const r = tiles_of(screen, kernels[i].position, kernels[i].radius);
        for (int y = r.first.y; y < r.last.y; ++y)
            for (int x = r.first.x; x < r.last.x; ++x)
                atomic_add(counts[std::size_t(y * screen.columns() + x)], 1);
    }
};

/// Item = photon. Writes it to the lists of its tiles, in any order.
struct FillTiles {
    ScreenMap screen;
    View<PhotonKernel const> kernels;
    View<std::uint32_t> next; ///< per tile: first free place
    View<std::uint32_t> list;

    GI_FN void operator()(std::size_t i) const
    {
        TileRange const r = tiles_of(screen, kernels[i].position, kernels[i].radius);
        for (int y = r.first.y; y < r.last.y; ++y)
            for (int x = r.first.x; x < r.last.x; ++x)
                list[atomic_add(next[std::size_t(y * screen.columns() + x)], 1)] = std::uint32_t(i);
    }
};

/// Item = tile. Sorts its list by heap sort, so that sums have one order.
struct SortTiles {
    View<std::uint32_t const> ends; ///< per tile; the first begins at 0
    View<std::uint32_t> list;

    GI_FN void operator()(std::size_t tile) const
    {
        std::uint32_t const begin = tile == 0 ? 0 : ends[tile - 1], n = ends[tile] - begin;
        std::uint32_t* const a = list.data + begin;
        auto const sink = [a](std::uint32_t at, std::uint32_t size) {
            for (std::uint32_t child; (child = 2 * at + 1) < size; at = child) {
                if (child + 1 < size && a[child + 1] > a[child]) ++child;
                if (a[at] >= a[child]) return;
                std::uint32_t const v = a[at];
                a[at] = a[child];
                a[child] = v;
            }
        };
        for (std::uint32_t k = n / 2; k > 0; --k) sink(k - 1, n);
        for (std::uint32_t size = n; size > 1;) {
            --size;
            std::uint32_t const v = a[0];
            a[0] = a[size];
            a[size] = v;
            sink(0, size);
        }
    }
};

/// Photons by tiles.
struct TilesView {
    ScreenMap screen;
    View<std::uint32_t const> ends; ///< per tile
    View<std::uint32_t const> list; ///< indices of kernels
    View<PhotonKernel const> kernels;
    View<Photon const> photons;

    GI_FN View<std::uint32_t const> of_tile(std::size_t tile) const
    {
        std::uint32_t const begin = tile == 0 ? 0 : ends[tile - 1];
        return {list.data + begin, ends[tile] - begin};
    }
};

} // namespace gi
