#pragma once
// Pictures in which there is nothing to see, since the camera looks elsewhere or the scene is tiny.

#include "gi/core/report.h"
#include "gi/scene/model/world.h"

#include <string_view>

namespace viewer {

inline constexpr std::string_view kSeesNothing = "pictures whose camera sees no surface",
                                  kSeesSpeck = "pictures in which the scene is a speck";

/// Reports a loss if no triangle lies in the view, or all that do cover a few pixels. Triangles that are hidden by
/// others or cut out count as seen.
void report_empty_view(gi::World const& world, gi::Camera const& camera, int width, int height,
                       gi::Report& report);

} // namespace viewer
