#pragma once
// Basic error measures of linear values. Definitions: docs/methods/errors.md. Pairs with a value that is not finite are
// omitted and counted.

#include "gi/core/math.h"

#include <vector>

namespace gi {

inline constexpr double kRelativeFloor = 0.01; ///< of relMSE: prevents black pixels from dominating

/// All NaN if no pair is finite.
struct ErrorSums {
    double rmse = 0;
    double relmse = 0;
    dvec3 bias{1};        ///< mean(image) / mean(reference) per channel
    double mean_bias = 1; ///< over all channels
    std::size_t not_finite = 0;
};

/// @param image, reference  interleaved values of `channels` per pixel
ErrorSums measure_errors(std::vector<float> const& image, std::vector<float> const& reference, int channels);
/// 10 log10(1 / MSE) of values in [0, 1]; infinite for equal pictures.
double psnr(std::vector<float> const& image, std::vector<float> const& reference);

} // namespace gi
