#include "gi/hit_buffers/hit_buffer.h"

#include <algorithm>

namespace gi {

void sort_layers(HitLayer* first, HitLayer* last)
{
    constexpr std::ptrdiff_t kFew = 24;
    if (last - first > kFew) {
        std::sort(first, last, before);
        return;
    }
    for (HitLayer* i = first + 1; i < last; ++i) {
        HitLayer const moved = *i;
        HitLayer* to = i;
        for (; to > first && before(moved, to[-1]); --to) *to = to[-1];
        *to = moved;
    }
}

namespace {

/// Compacts the first `most` layers of every texel.
void cut(HitBuffer& b, std::uint32_t most)
{
    std::uint32_t kept = 0, first = 0;
    for (std::size_t t = 0; t + 1 < b.offset.size(); ++t) {
        std::uint32_t const last = b.offset[t + 1], n = std::min(last - first, most);
        std::copy_n(b.layers.begin() + first, n, b.layers.begin() + kept);
        kept += n;
        first = last;
        b.offset[t + 1] = kept;
    }
    b.lost = b.layers.size() - kept;
    b.layers.resize(kept);
}

} // namespace

void fill_hit_buffer(Fragments const& f, RasterGrid const& grid, std::uint32_t most_layers, HitBuffer& out)
{
    std::size_t const texels = grid.texels();
    out.grid = grid;
    out.lost = 0;
    // offset[t + 1] first counts the layers of t, then is the position of the next one
    // to insert, and so finally their end.
    out.offset.assign(texels + 1, 0);
    std::uint32_t* const next = out.offset.data() + 1;
    for (std::size_t k = 0; k < f.count; ++k) ++next[f.texel[k]];
    std::uint32_t sum = 0;
    for (std::size_t t = 0; t < texels; ++t) {
        std::uint32_t const n = next[t];
        next[t] = sum;
        sum += n;
    }
    out.layers.resize(f.count);
    for (std::size_t k = 0; k < f.count; ++k) out.layers[next[f.texel[k]]++] = {f.depth[k], f.primitive[k]};
    for (std::size_t t = 0; t < texels; ++t)
        sort_layers(out.layers.data() + out.offset[t], out.layers.data() + out.offset[t + 1]);
    if (most_layers > 0) cut(out, most_layers);
}

HitBuffer make_hit_buffer(TriangleSoup const& soup, RasterGrid const& grid, MacroPath macro,
                          std::uint32_t most_layers)
{
    BorrowedFragments fragments;
    rasterize(soup, 0, soup.count, grid, macro, *fragments);
    HitBuffer b;
    fill_hit_buffer(*fragments, grid, most_layers, b);
    return b;
}

} // namespace gi
