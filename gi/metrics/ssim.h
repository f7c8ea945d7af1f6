#pragma once
#include <vector>

namespace gi {

/// Structural similarity of two grey pictures with values in [0, 1]: 11 x 11 Gaussian windows of sigma 1.5 that
/// lie inside the picture (Wang et al. 2004). Mean over the windows, 1 = equal. Pictures smaller than a window get
/// one window of their own size.
double ssim(std::vector<float> const& image, std::vector<float> const& reference, int width, int height);

} // namespace gi
