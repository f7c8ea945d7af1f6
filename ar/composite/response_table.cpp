#include "ar/composite/response_table.h"

#include <limits>

namespace ar {

ResponseTable::ResponseTable(std::array<float, 256> const& unit_of_byte) : unit_(unit_of_byte)
{
    for (std::size_t b = 0; b < 255; ++b) border_[b] = 0.5f * (unit_[b] + unit_[b + 1]);
    border_[255] = unit_[255];
    float const infinity = std::numeric_limits<float>::infinity();
    for (std::size_t b = 0; b < 256; ++b) {
        bool const equal = b > 0 && unit_[b] == unit_[b - 1];
        least_[b] = b == 0 ? -infinity : equal ? least_[b - 1] : border_[b - 1];
    }
    for (std::size_t b = 256; b-- > 0;) {
        bool const equal = b < 255 && unit_[b] == unit_[b + 1];
        most_[b] = b == 255 ? infinity : equal ? most_[b + 1] : border_[b];
    }
    scale_ = unit_[255] > unit_[0] ? float(kCells) / (unit_[255] - unit_[0]) : 0;
    std::size_t b = 0;
    for (std::size_t i = 0; i <= kCells; ++i) {
        // Half a cell lower: rounding must not begin above the nearest byte.
        float const from = scale_ > 0 ? unit_[0] + (float(i) - 0.5f) / scale_ : unit_[0];
        while (b < 255 && border_[b] < from) ++b;
        first_[i] = std::uint8_t(b);
    }
}

} // namespace ar
