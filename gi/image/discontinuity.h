#pragma once
// Discontinuity buffer: the mean over a window of those pixels whose surface agrees with the one in the middle
// (Keller & Heidrich 2001, Wald et al. 2002, sec. 4.2). Made for samples that are interleaved in n x n pixels:
// each of their patterns has the same share in every mean.

#include "gi/image/filter_input.h"

namespace gi {

/// @param window pixels across, 1 to kMaxWindow. Even ones reach half a pixel further: the outermost count half
/// @return the light, filtered; luminance and variance are left out
Planes filter_discontinuity(FilterInput const& input, int window);

} // namespace gi
