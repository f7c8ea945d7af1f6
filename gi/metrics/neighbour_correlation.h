#pragma once
// Correlation of the errors of neighbouring pixels. Independent noise gives 0 and can be filtered; an error
// shared by whole regions gives values near 1, and no filter can distinguish it from the picture.

#include <vector>

namespace gi {

inline constexpr float kErrorFloor = 0.1f; ///< radiance; root of the floor of relMSE

/// Correlation coefficient of e = (x - r) / (r + 0.1), x and r luminances, over all horizontal and vertical pairs
/// of neighbours. Pairs with a value that is not finite are omitted; NaN if no pair remains or e is constant.
/// @param image, reference  width * height * 3 linear values
float neighbour_correlation(std::vector<float> const& image, std::vector<float> const& reference, int width,
                            int height);

} // namespace gi
