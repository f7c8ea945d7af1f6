#pragma once
// Filtered light that a picture takes from a partner whose picture has already been filtered.

#include "gi/filter/filter_area.h"
#include "gi/filter/filter_input.h"

#include <optional>

namespace gi {

struct FilteredLight {
    FilterArea area;
    /// Direct and indirect light as in namespace light, for pixels that are near but not wanted; none = the
    /// picture's own light is used unchanged.
    std::optional<Planes> light;
};

/// Replaces L1, L2 and color of all unwanted surfaces by the partner's light,
/// rescaled to the picture's own albedo.
/// @param report  counts pixels that keep their values because the partner's light is not finite
/// @return the partner's light
Planes take_filtered(Picture& picture, ReusedLight const& taken, FilterArea const& area, DenoiseReport& report);

} // namespace gi
