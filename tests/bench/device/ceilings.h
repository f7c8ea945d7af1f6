#pragma once
// What the machine can do at most: bytes copied, and records read in random order, as kernels.

#include "gi/core/rng.h"
#include "gi/core/view.h"

#include <cstdint>

namespace gi::bench {

struct alignas(16) Words {
    std::uint32_t word[4];
};

/// Reads and writes every word once.
struct CopyWords {
    View<Words const> from;
    View<Words> to;

    GI_FN void operator()(std::size_t i) const { to[i] = from[i]; }
};

/// Each item reads `kReads` records of 32 bytes in places that do not depend on each other.
struct ReadAnywhere {
    static constexpr int kReads = 16;
    View<Words const> from; ///< their number is a power of two
    View<std::uint32_t> sums;

    GI_FN void operator()(std::size_t i) const
    {
        std::uint32_t sum = 0;
        for (int k = 0; k < kReads; ++k) {
            std::size_t const at = mix_bits(i * kReads + std::size_t(k)) & (from.size() - 2);
            sum += from[at].word[0] + from[at + 1].word[3];
        }
        sums[i] = sum;
    }
};

} // namespace gi::bench
