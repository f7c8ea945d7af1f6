#pragma once
// Conversion of measured spectra to the renderer's three colour channels.

#include "gi/core/math.h"

#include <span>

namespace gi {

/// Spectrum sampled every `step_nm` from `first_nm` on; linear between the samples and constant outside.
struct Spectrum {
    double first_nm, step_nm;
    std::span<double const> values;
    double at(double nm) const;
};

/// Colour matching functions x, y, z of the CIE 1931 observer:
/// the fit of Wyman et al. 2013, within 2 % of the peak.
dvec3 cie_observer(double nm);
/// Returns linear Rec. 709 (white point D65); colours outside the gamut have negative channels.
dvec3 xyz_to_rec709(dvec3 xyz);

/// Returns linear Rec. 709 by the CIE 1931 observer (fit of Wyman et al. 2013), scaled so that the constant
/// spectrum 1 gives (1, 1, 1): channels are relative to equal-energy white. Negative values become 0.
vec3 to_rgb(Spectrum const& spectrum);

} // namespace gi
