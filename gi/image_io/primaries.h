#pragma once
// Colours of other primaries as those of Rec. 709.

#include "gi/core/math.h"

#include <optional>

namespace gi {

/// CIE 1931 (x, y) of the primaries and of R = G = B = 1.
struct Primaries {
    glm::dvec2 red{0.64, 0.33}, green{0.3, 0.6}, blue{0.15, 0.06}, white{0.3127, 0.329}; ///< Rec. 709

    /// As far as chromaticities are written: three digits.
    bool is_rec709() const;
};

/// Weights of red, green and blue in the luminance Y. Nothing where the primaries span no colours.
std::optional<dvec3> luminance_weights(Primaries const& primaries);

/// Linear RGB of these primaries to linear Rec. 709; white stays white (Bradford's adaptation, as OpenEXR's
/// AcesInputFile does it). Nothing where the primaries span no colours.
std::optional<glm::dmat3> to_rec709(Primaries const& primaries);

} // namespace gi
