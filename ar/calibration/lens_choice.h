#pragma once
// Which lens model: that which predicts views that it has not seen.

#include "ar/calibration/lens.h"

namespace ar {

struct LensTrial {
    LensModel lens = LensModel::pinhole;
    double fitted_rms_px = 0; ///< of the views it was fitted to
    /// Of views left out of the fit, five groups in turn; only their poses are fitted.
    double validated_rms_px = 0;
    std::string failed; ///< why there are no numbers
};

struct LensChoice {
    std::vector<LensTrial> trials;
    LensModel chosen = LensModel::radial_tangential;
    std::string why;
};

/// The model with the fewest coefficients whose validated error is within 2 % of the least.
/// @throws gi::InputError no model can be fitted
LensChoice choose_lens(std::vector<BoardView> const& views, glm::ivec2 size_px, LensOptions const& options = {});

} // namespace ar
