#include "gi/raster/nearest_map.h"

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
        NearestTexel& t = map.texels[f.texel[k]];
        float const key = key_sign * f.depth[k];
        std::uint32_t const primitive = f.primitive[k] & kPrimitiveMask;
        if (key > t.key || (key == t.key && primitive < t.primitive)) t = {key, primitive};
    }
}

} // namespace gi
