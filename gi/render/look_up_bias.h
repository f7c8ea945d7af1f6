#pragma once
// How far light by look-ups is from that of exact rays.

#include <cstdint>

namespace gi {

/// A relative difference of two means (0.01: 1 % too bright), and half of its 95 % interval.
struct Deviation {
    double value = 0, error = 0;
    double of_all = 0; ///< the difference as a share of all light, direct and indirect
};

struct LookUpBias {
    Deviation direct, indirect; ///< of light after one and after more scatterings, in the picture's mean
    std::uint64_t paths = 0;    ///< traced both ways
};

} // namespace gi
