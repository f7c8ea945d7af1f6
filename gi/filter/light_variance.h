#pragma once
// Separate variances of direct and indirect light at each pixel, for a-trous: shadows in direct light with little
// noise stay sharp only if the noise of indirect light is not counted with it.

#include "gi/filter/filter_input.h"

namespace gi {

/// Fills in the variance of the light. Single estimates are too noisy, so they are averaged over 5 x 5 pixels. If
/// variances were measured over frames, direct and indirect light each use their own; pixels with too few
/// measured neighbours use the variance over 7 x 7 pixels of similar surfaces. Otherwise the picture's variance
/// is split in proportion to the squared second differences of the two luminances: the smaller of the differences
/// along rows and along columns, because edges raise only one of them and noise raises both.
void find_variances(FilterInput& input);

} // namespace gi
