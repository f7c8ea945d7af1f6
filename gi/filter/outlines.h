#pragma once
// Pixels on outlines and thin objects agree with few of their neighbours and stay noisy in an edge-avoiding
// filter. If their noise is large, averaging with neighbours, even on another surface, reduces their error.

#include "gi/filter/filter_input.h"

namespace gi {

/// The last step of the a-trous filter: a weighted mean of the pixel and its eight neighbours, of direct and of
/// indirect light. The pixel's weight is 1 / v, where v is its variance after the filter. A neighbour's is
///   g max(0, 1 - 2 v_n / v) / (v_n + min(1, d^2) b^2),
/// so only those with less than half its variance count. d^2 is the difference of the surfaces, and b^2 an
/// estimate of the squared difference of light on another surface: the variance among the neighbours, plus the
/// square of their mean m, plus the difference of the two pixels beyond noise, max(0, (l_n - l)^2 - v).
/// g = max(0, 1 - m^2 / 5 v): pixels with a relative error below 45 % and pixels without variance are unchanged.
/// @param light  filtered, with luminance and variance  @param out  receives the colours of wanted pixels
void smooth_outlines(Planes const& guides, Planes const& light, RowSpans const& wanted, Planes& out);

} // namespace gi
