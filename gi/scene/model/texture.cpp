#include "gi/scene/model/texture.h"

#include "gi/core/srgb.h"

#include <array>

namespace gi {

View<float const> linear_of_srgb()
{
    static std::array<float, 256> const table = [] {
        std::array<float, 256> t;
        for (std::size_t i = 0; i < t.size(); ++i) t[i] = float(decode_srgb(double(i) / 255));
        return t;
    }();
    return {table.data(), table.size()};
}

} // namespace gi
