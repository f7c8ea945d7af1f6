#pragma once
// Edge-avoiding a-trous wavelet: a 5 x 5 B3 spline whose taps lie 1, 2, 4, ... pixels apart, times how well
// normal, plane, albedo and luminance at the tap agree with those in the middle (Dammertz et al. 2010); the
// difference of luminances counts in standard deviations, and the variance is filtered along (Schied et al. 2017,
// sec. 4.4).
//
// Instead of products of exponentials, all differences add up as squares to d^2 and the weight is
// max(0, 1 - d^2)^2: no exponential, and exactly 0 across edges. Direct and indirect light share all but the
// luminance. At the end, pixels that stayed noisy on outlines are smoothed (gi/filter/outlines.h).

#include "gi/filter/filtered_light.h"

namespace gi {

/// @param iterations 1 to kMaxIterations
/// @param known  is kept, and from the second iteration on seen by what is wanted
/// @return the light, filtered; input.light is used up
Planes filter_atrous(FilterInput& input, int iterations, FilteredLight const& known);

} // namespace gi
