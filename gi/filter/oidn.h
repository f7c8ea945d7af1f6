#pragma once
// The filter oidn: Intel Open Image Denoise, a U-Net trained on path-traced pictures
// (https://www.openimagedenoise.org), on the CPU. It filters L1 and L2 separately, each with albedo and normal as
// auxiliary layers, so that color = L0 + L1 + L2 holds afterwards and L0 keeps its edges.

#include "gi/filter/denoise.h"

namespace gi {

/// Throws InputError if Open Image Denoise is not installed or does not start.
void check_oidn();

/// Replaces L1, L2 and color of all surfaces. Pixels with a value that is not finite keep their values; the filter
/// gets the mean of their neighbours instead. Throws InputError like check_oidn, and if a layer is missing.
/// @param stop  once it is requested, throws Interrupted; null = never
DenoiseReport filter_oidn(Picture& picture, OidnQuality quality, int threads, StopRequest const* stop);

} // namespace gi
