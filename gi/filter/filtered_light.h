#pragma once
// Filtered light that a picture takes from a partner that has been filtered.

#include "gi/filter/filter_area.h"
#include "gi/filter/filter_input.h"

#include <optional>

namespace gi {

struct FilteredLight {
    FilterArea area;
    /// Direct and indirect light as in namespace light, near what is wanted but not there; none = that of the
    /// picture stays as it is.
    std::optional<Planes> light;
};

/// Replaces L1, L2 and color of all surfaces that are not wanted by the partner's light over its albedo times the
/// picture's.
/// @param report  gets pixels that keep their values, as what they would take is not finite
/// @return that light
Planes take_filtered(Picture& picture, ReusedLight const& taken, FilterArea const& area, DenoiseReport& report);

} // namespace gi
