#pragma once
// Chooses the lens model by cross-validation: how well it predicts views that were left out of the fit.

#include "ar/calibration/lens.h"

namespace ar {

struct LensTrial {
    LensModel lens = LensModel::pinhole;
    double fitted_rms_px = 0; ///< error on the views it was fitted to
    /// Error on views left out of the fit (5-fold cross-validation); only their poses are fitted.
    double validated_rms_px = 0;
    std::string failed; ///< reason if the model could not be fitted
};

struct LensChoice {
    std::vector<LensTrial> trials;
    LensModel chosen = LensModel::radial_tangential;
    std::string why;
};

/// Returns the model with the fewest coefficients whose validated error is within 2 % of the smallest.
/// @throws gi::InputError if no model can be fitted
LensChoice choose_lens(std::vector<BoardView> const& views, glm::ivec2 size_px, LensOptions const& options = {});

} // namespace ar
