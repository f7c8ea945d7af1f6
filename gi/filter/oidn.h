#pragma once
// The filter oidn: Intel Open Image Denoise, a U-Net trained on path-traced pictures
// (https://www.openimagedenoise.org), on the processor. It takes L1 and L2 one after the other, each with the
// layers albedo and normal beside it, so that color = L0 + L1 + L2 holds afterwards and L0 keeps its edges.

#include "gi/filter/denoise.h"

namespace gi {

/// Throws InputError where Open Image Denoise is not installed or refuses to start.
void check_oidn();

/// Replaces L1, L2 and color where there is a surface. Pixels with a value that is not finite keep their values;
/// the filter sees the mean of their neighbours instead. Throws InputError as check_oidn, and where a layer is
/// missing.
DenoiseReport filter_oidn(Picture& picture, OidnQuality quality, int threads);

} // namespace gi
