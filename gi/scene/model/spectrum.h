#pragma once
// From measured spectra to the three channels of the renderer.

#include "gi/core/math.h"

#include <span>

namespace gi {

/// A spectrum sampled every `step_nm` from `first_nm` on, linear in between and constant beyond.
struct Spectrum {
    double first_nm, step_nm;
    std::span<double const> values;
    double at(double nm) const;
};

/// Colour matching functions x, y, z of the CIE 1931 observer: the fit of Wyman et al. 2013, within 2 % of the
/// peak.
dvec3 cie_observer(double nm);
/// Linear Rec. 709, whose white is D65; colours outside its triangle have negative channels.
dvec3 xyz_to_rec709(dvec3 xyz);

/// Linear Rec. 709 by the CIE 1931 observer (fit of Wyman et al. 2013), scaled so that the constant spectrum 1
/// gives (1, 1, 1): channels are relative to equal-energy white. Negative values become 0.
vec3 to_rgb(Spectrum const& spectrum);

} // namespace gi
