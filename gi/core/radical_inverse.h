#pragma once
#include <cstddef>

namespace gi {

/// Radical inverse of i (its digits mirrored at the radix point), in [0, 1); bases 2 and 3 give Halton's points.
inline double radical_inverse(std::size_t i, std::size_t base)
{
    double out = 0, digit = 1;
    for (; i > 0; i /= base) {
        digit /= double(base);
        out += digit * double(i % base);
    }
    return out;
}

} // namespace gi
