#pragma once
// Motion vectors of what a G-buffer shows, see gi/render/motion.h.

#include "gi/methods/slhb/lights/primary_map.h"
#include "gi/render/motion.h"

namespace gi {

/// The corners of triangles from `first` on, as the soup has them.
std::vector<Corners> corners_of(TriangleSoup const& soup, std::size_t first);

/// @param now  of the frame, whose last pass `primary` holds
void add_motion(PrimaryMap const& primary, TriangleSoup const& soup, CameraRays const& now,
                CameraRays const& camera_before, EarlierCorners const& before, Picture& picture);

} // namespace gi
