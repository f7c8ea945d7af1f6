#pragma once
// How much of their error neighbouring pixels share. Independent noise gives 0, and filters remove it; an error
// that whole regions have in common gives values near 1, and no filter can tell it from the picture.

#include <vector>

namespace gi {

inline constexpr float kErrorFloor = 0.1f; ///< radiance; root of the floor of relMSE

/// Correlation coefficient of e = (x - r) / (r + 0.1), x and r luminances, over all horizontal and vertical pairs
/// of neighbours. Pairs with a value that is not finite are left out; NaN where no pair is left or e does not
/// vary.
/// @param image, reference  width * height * 3 linear values
float neighbour_correlation(std::vector<float> const& image, std::vector<float> const& reference, int width,
                            int height);

} // namespace gi
