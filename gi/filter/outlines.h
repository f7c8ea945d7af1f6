#pragma once
// Pixels that agree with few of their neighbours, on outlines and thin things, stay noisy in a filter that stops
// at edges. Where their noise is large they are better off with what their neighbours have, even of another
// surface.

#include "gi/filter/filter_input.h"

namespace gi {

/// The last step of the a-trous filter: a weighted mean of the pixel and its eight neighbours, of direct and of
/// indirect light. The pixel's weight is 1 / v, v being the variance that the filter left it. A neighbour's is
///   g max(0, 1 - 2 v_n / v) / (v_n + min(1, d^2) b^2),
/// so only those with less than half its variance count. d^2 is how far the surfaces differ, and b^2 how far the
/// light of another surface may be off: the variance among the neighbours, plus the square of their mean m, plus
/// what the two pixels differ by beyond noise, max(0, (l_n - l)^2 - v). g = max(0, 1 - m^2 / 5 v): pixels with a
/// relative error below 45 % stay as they are, and so do those without variance.
/// @param light  filtered, with luminance and variance   @param out  gets the colours of what is wanted
void smooth_outlines(Planes const& guides, Planes const& light, RowSpans const& wanted, Planes& out);

} // namespace gi
