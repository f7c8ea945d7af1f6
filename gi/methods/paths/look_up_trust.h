#pragma once
// Estimates whether look-ups in hit buffers of some resolution are accurate in what a camera sees. A look-up uses
// the column under a texel's centre instead of that under its origin; if the four columns around the origin give
// the same result, so would the origin's own. If texels are too large for a place (a room in a large world,
// windows, furniture), the columns disagree, or lack the surface that the look-up starts from, or a texel is
// large compared with the distance to what the camera sees.

#include "gi/core/report.h"
#include "gi/hit_buffers/settings.h"
#include "gi/raster/triangle_soup.h"
#include "gi/scene/model/camera.h"

namespace gi {

/// @return fraction of look-ups whose four columns contain the starting surface and agree, for points that the
///   camera sees and points hit from there along two axes; 1 if the camera sees nothing, 0 if a texel is larger
///   than 1/16 of the median distance to what the camera sees
/// @param camera  not orthographic  @param settings  chosen ones
double look_up_agreement(World const& world, TriangleSoup const& soup, CameraRays const& camera,
                         SlhbSettings const& settings);
/// Below this agreement light by look-ups is not reliable.
inline constexpr double kTrustedLookUps = 0.87;
/// Reports a loss if it is so far below that light is biased by percents: the estimate of error holds noise alone, and nothing else would tell.
void report_untrusted_look_ups(World const& world, TriangleSoup const& soup, CameraRays const& camera,
                               SlhbSettings const& settings, Report& report);

} // namespace gi
