#pragma once
// Settings of paths that start at the camera: of the method paths, and of those that find surfaces or
// shadows in other ways (gi/methods/slhb).

#include <cstdint>

namespace gi {

/// Whether paths may end in cells of a cache, see radiance_cache.h.
enum class RadianceCaching : std::uint8_t {
    automatic, ///< on for pictures with a budget, and for frames whose caller requests it
    on,
    off
};

struct PathsSettings {
    RadianceCaching cache = RadianceCaching::automatic;
    /// Paths continue with a probability of this times their throughput; 0 = always up to the fourth scattering,
    /// then as in the reference; -1 = chosen by the plan.
    float roulette = -1;
    /// n: compute indirect light for one pixel in each n x n block per pass, weighted by n^2; 1 = for all.
    int interleave = 0;
};

} // namespace gi
