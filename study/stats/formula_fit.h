#pragma once
#include "study/stats/psychometric_fit.h"

namespace study {

/// As fit_psychometric(), for a shape with a formula of P: the derivatives are central differences, and the slope
/// is searched from 0.001 to 1000, because its unit is that of the formula.
/// @throws std::invalid_argument as fit_psychometric(), or a formula that gives no proportion at the levels
PsychometricFit fit_formula(std::span<LevelCount const> counts, PsychometricSettings const& settings);

} // namespace study
