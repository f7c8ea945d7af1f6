#include "gi/raster/fragments.h"

#include <algorithm>

namespace gi {

void Fragments::grow(std::size_t needed)
{
    capacity = std::max({needed, 2 * capacity, std::size_t(4096)});
    auto const move = [&](auto& array) {
        using T = std::remove_reference_t<decltype(array[0])>;
        std::unique_ptr<T[]> larger(new T[capacity]);
        std::copy_n(array.get(), count, larger.get());
        array = std::move(larger);
    };
    move(texel);
    move(depth);
    move(primitive);
}

} // namespace gi
