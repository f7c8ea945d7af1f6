#pragma once
// What two pictures' metadata say about comparing them.

#include "gi/image_io/picture.h"

namespace gi {

/// Why figures of this comparison may mislead, as sentences; empty = nothing is known against it: other scenes or
/// views, one seed for both, a reference with fewer paths or with noise of its own (`estimated_relmse`), a variance
/// from before a filter, values above 1 beside a file that ends at 1. Pictures of one and the same command are not
/// doubted: they are compared to see that nothing has changed.
/// @param relmse  that was measured; NaN = it was not  @param is_z_test  a z-test was among the metrics
std::vector<std::string> provenance_notes(Picture const& image, Picture const& reference, double relmse,
                                          bool is_z_test);

} // namespace gi
