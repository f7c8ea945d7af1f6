#include "gi/scene/model/texture.h"

#include <array>

namespace gi {

View<float const> linear_of_srgb()
{
    static std::array<float, 256> const table = [] {
        std::array<float, 256> t;
        for (std::size_t i = 0; i < t.size(); ++i) {
            double const s = double(i) / 255;
            t[i] = float(s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4));
        }
        return t;
    }();
    return {table.data(), table.size()};
}

} // namespace gi
