#include "gi/raster/nearest_map.h"

#include <atomic>

namespace gi {

void clear(NearestMap& map, std::uint32_t width, std::uint32_t height)
{
    map.width = width;
    map.height = height;
    map.texels.assign(std::size_t(width) * height, {});
}

void resolve(Fragments const& f, float key_sign, NearestMap& map)
{
    for (std::size_t k = 0; k < f.count; ++k) {
        std::atomic_ref<NearestTexel> const texel(map.texels[f.texel[k]]);
        NearestTexel const now{key_sign * f.depth[k], f.primitive[k] & kPrimitiveMask};
        NearestTexel there = texel.load(std::memory_order_relaxed);
        auto const nearer = [&] {
            return now.key > there.key || (now.key == there.key && now.primitive < there.primitive);
        };
        while (nearer() && !texel.compare_exchange_weak(there, now, std::memory_order_relaxed)) {}
    }
}

} // namespace gi
