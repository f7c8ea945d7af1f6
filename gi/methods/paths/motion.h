#pragma once
// Motion vectors of the surfaces in a G-buffer, see gi/render/motion.h.

#include "gi/methods/paths/primary_map.h"
#include "gi/render/motion.h"

namespace gi {

/// Returns the corners of the soup's triangles from `first` on.
std::vector<Corners> corners_of(TriangleSoup const& soup, std::size_t first);

/// @param now  camera of the frame whose last pass is in `primary`
void add_motion(PrimaryMap const& primary, TriangleSoup const& soup, CameraRays const& now,
                CameraRays const& camera_before, EarlierCorners const& before, Picture& picture);

} // namespace gi
