#pragma once
// Discontinuity buffer: the mean over a window of those pixels whose surface agrees with the one in the middle
// (Keller & Heidrich 2001, Wald et al. 2002, sec. 4.2). Made for samples that are interleaved in n x n pixels:
// each of their patterns has the same share in every mean. Indirect light changes slowly over a surface: the means
// of the windows around may be averaged once more (as a step of an a-trous wavelet does, Dammertz et al. 2010).

#include "gi/filter/filtered_light.h"

namespace gi {

/// @param window pixels across, 1 to kMaxWindow. Even ones reach half a pixel further: the outermost count half
/// @param reach  windows to each side whose means are averaged for indirect light; 0 = none.
/// window * reach <= Planes::kMargin
/// @param known  is kept; means of windows are taken from it too, but for the first around what is wanted
/// @return the light, filtered; luminance and variance are left out
Planes filter_discontinuity(FilterInput const& input, int window, int reach, FilteredLight const& known);

} // namespace gi
