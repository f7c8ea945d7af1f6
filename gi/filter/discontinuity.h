#pragma once
// Discontinuity buffer: the mean over those pixels of a window whose surface agrees with the central pixel's
// (Keller & Heidrich 2001, Wald et al. 2002, sec. 4.2). Made for samples interleaved in n x n pixels: every mean
// contains each sampling pattern equally often. As indirect light changes slowly over a surface, the means of
// surrounding windows can be averaged once more (as a step of an a-trous wavelet does, Dammertz et al. 2010).

#include "gi/filter/filtered_light.h"

namespace gi {

/// @param window  width in pixels, 1 to kMaxWindow. Even windows extend half a pixel further on each side: their
///   outermost pixels have weight 1/2
/// @param reach  windows to each side whose means are averaged for indirect light; 0 = none.
/// window * reach <= Planes::kMargin
/// @param known  filtered light of the partner: left unchanged. It is used only when window means are averaged
///   again, not in the first window means around wanted pixels
/// @return the filtered light, without luminance and variance
Planes filter_discontinuity(FilterInput const& input, int window, int reach, FilteredLight const& known);

} // namespace gi
