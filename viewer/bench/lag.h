#pragma once
// What temporal reuse adds to the error of frames apart from noise: light of earlier moments that is no longer
// true, and what the clamp takes away. Over several seeds, the mean of a reused frame less that of the same frame
// alone is that error and what noise is left; the product of two such differences, of different seeds, has the
// square of the error as its mean.

#include "gi/image_io/picture.h"

#include <array>
#include <vector>

namespace viewer {

class LagError {
public:
    explicit LagError(std::size_t frames) : differences_(frames) {}

    /// Color of frame `frame` of seed number `seed`, with reuse and without, through the same filter.
    void add(std::size_t seed, std::size_t frame, gi::Picture const& reused, gi::Picture const& alone);
    /// Mean of the error's square over truth^2 + 0.01, as relMSE has it; below zero by chance where it is small.
    /// NaN with fewer than 2 seeds.
    double relmse(std::size_t frame, gi::Picture const& truth) const;

private:
    struct Half {
        std::vector<float> sum; ///< reused less alone, over seeds
        int seeds = 0;
    };
    std::vector<std::array<Half, 2>> differences_; ///< per frame, of even and odd seeds
};

} // namespace viewer
