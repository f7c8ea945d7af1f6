#pragma once
#include <vector>

namespace gi {

/// Structural similarity of two grey pictures with values in [0, 1] (Wang et al. 2004):
/// mean over all 11 x 11 Gaussian windows (sigma 1.5) inside the picture, 1 = equal.
/// Pictures smaller than a window use one window of their own size.
double ssim(std::vector<float> const& image, std::vector<float> const& reference, int width, int height);

} // namespace gi
