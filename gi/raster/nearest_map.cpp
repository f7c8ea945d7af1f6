#include "gi/raster/nearest_map.h"

#include <atomic>

namespace gi {

void clear(NearestMap& map, std::uint32_t width, std::uint32_t height)
{
    map.width = width;
    map.height = height;
    map.texels.assign(std::size_t(width) * height, {});
}

namespace {

bool nearer(NearestTexel a, NearestTexel b)
{
    return a.key > b.key || (a.key == b.key && a.primitive < b.primitive);
}

NearestTexel texel_of(Fragments const& f, std::size_t k, float key_sign)
{
    return {key_sign * f.depth[k], f.primitive[k] & kPrimitiveMask};
}

} // namespace

void resolve(Fragments const& f, float key_sign, NearestMap& map)
{
    for (std::size_t k = 0; k < f.count; ++k) {
        NearestTexel& there = map.texels[f.texel[k]];
        NearestTexel const now = texel_of(f, k, key_sign);
        if (nearer(now, there)) there = now;
    }
}

void resolve_shared(Fragments const& f, float key_sign, NearestMap& map)
{
    for (std::size_t k = 0; k < f.count; ++k) {
        std::atomic_ref<NearestTexel> const texel(map.texels[f.texel[k]]);
        NearestTexel const now = texel_of(f, k, key_sign);
        NearestTexel there = texel.load(std::memory_order_relaxed);
        while (nearer(now, there) && !texel.compare_exchange_weak(there, now, std::memory_order_relaxed)) {
        }
    }
}

} // namespace gi
