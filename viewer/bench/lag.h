#pragma once
// Error that temporal reuse adds to frames apart from noise: outdated light of earlier moments, and light removed
// by the clamp. The mean over several seeds of a frame with reuse minus the same frame without is that error plus
// remaining noise; the expected product of two such differences from different seeds is the square of the error.

#include "gi/image_io/picture.h"

#include <array>
#include <vector>

namespace viewer {

class LagError {
public:
    explicit LagError(std::size_t frames) : differences_(frames) {}

    /// Adds layer color of frame `frame` with seed number `seed`, with and without reuse, through the same filter.
    void add(std::size_t seed, std::size_t frame, gi::Picture const& reused, gi::Picture const& alone);
    /// Mean of squared error / (truth^2 + 0.01), as in relMSE; may be slightly negative by chance.
    /// NaN with fewer than 2 seeds.
    double relmse(std::size_t frame, gi::Picture const& truth) const;

private:
    struct Half {
        std::vector<float> sum; ///< sum over seeds of `reused` minus `alone`
        int seeds = 0;
    };
    std::vector<std::array<Half, 2>> differences_; ///< per frame, for even and odd seeds
};

} // namespace viewer
