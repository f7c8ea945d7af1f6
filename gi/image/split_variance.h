#pragma once
// How much of a picture's variance belongs to direct and how much to indirect light: shadows are sharp where
// direct light has little noise, and they stay so only if the noise of indirect light does not count there.

#include "gi/image/filter_input.h"

namespace gi {

/// Fills in the variance of the light: the mean over 5 x 5 pixels (single estimates from few paths are too noisy:
/// where no path found a lamp they are 0), shared out like the squared second differences of the luminances. Of
/// those along rows and along columns the smaller counts, which edges leave alone and noise does not.
void split_variance(FilterInput& input);

} // namespace gi
