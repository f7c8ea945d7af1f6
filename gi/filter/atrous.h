#pragma once
// Edge-avoiding a-trous wavelet: a 5 x 5 B3 spline whose taps lie 1, 2, 4, ... pixels apart, weighted by how well
// normal, plane, albedo and luminance of the tap agree with those of the central pixel (Dammertz et al. 2010);
// luminance differences are measured in standard deviations, and the variance is filtered together with the light
// (Schied et al. 2017, sec. 4.4).
//
// Instead of products of exponentials, all differences add up as squares to d^2 and the weight is
// max(0, 1 - d^2)^2: no exponential, and exactly 0 across edges. Direct and indirect light share all of these
// terms except luminance. A last step smooths pixels on outlines that are still noisy (gi/filter/outlines.h).

#include "gi/filter/filtered_light.h"

namespace gi {

/// @param iterations  1 to kMaxIterations
/// @param known  filtered light of the partner: left unchanged, and used as
///   neighbours from the second iteration on
/// @return the filtered light; input.light is consumed
Planes filter_atrous(FilterInput& input, int iterations, FilteredLight const& known);

} // namespace gi
