#pragma once
#include <cstddef>

namespace gi {

/// The digits of i in a base, mirrored at the point: 0..1, without 1. Of bases 2 and 3,
/// Halton's points of a square.
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
