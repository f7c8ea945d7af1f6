#pragma once
// Motion vectors: where the surface under each pixel was in the frame before.

#include "gi/base/picture.h"
#include "gi/slhb/primary_map.h"

namespace gi {

/// Where triangles were in the frame before.
struct EarlierCorners {
    std::size_t first_moving = 0;             ///< triangle
    std::vector<std::array<vec3, 3>> corners; ///< of triangles from there on; empty = none has moved
};

/// The corners of triangles from `first` on, as they are now.
std::vector<std::array<vec3, 3>> corners_of(TriangleSoup const& soup, std::size_t first);

/// Adds the layer "motion": x, y in pixels from here to there, z the depth it had there, m; NaN where nothing is
/// seen or it was behind the camera. What stands still before a camera that stands still has 0, 0 exactly.
/// @param now  of the frame, whose last pass `primary` holds
void add_motion(PrimaryMap const& primary, TriangleSoup const& soup, CameraRays const& now,
                CameraRays const& camera_before, EarlierCorners const& before, Picture& picture);

} // namespace gi
