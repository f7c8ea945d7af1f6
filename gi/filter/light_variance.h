#pragma once
// The variance of direct and of indirect light at each pixel, as a-trous goes by it: shadows are sharp where
// direct light has little noise, and they stay so only if the noise of indirect light does not count there.

#include "gi/filter/filter_input.h"

namespace gi {

/// Fills in the variance of the light. Single estimates are too noisy, so means over 5 x 5 pixels count.
/// Where it was measured over frames, for each light its own; where nothing is known around, the variance over
/// 7 x 7 pixels of like surfaces. Otherwise that of the picture, shared out like the squared second differences of
/// the luminances: of those along rows and along columns the smaller counts, which edges leave alone and noise
/// does not.
void find_variances(FilterInput& input);

} // namespace gi
