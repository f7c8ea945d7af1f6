#pragma once
// Why nothing of the virtual objects is seen in a frame.

#include "ar/camera/camera_model.h"
#include "ar/camera/pose.h"

#include <string>
#include <vector>

namespace ar {

inline constexpr double kSmall_px = 4;

enum class Visibility {
    unknown, ///< nothing was rendered, or there are no virtual surfaces
    seen,
    behind,  ///< all of them are behind the camera
    outside, ///< in front of it, and outside of the picture
    small,   ///< smaller than kSmall_px in width and height
    hidden   ///< in the picture, and covered by the real scene
};
/// "behind the camera", "outside of the picture", ...; empty for unknown and seen.
std::string name_of(Visibility v);

/// @param corners_m  corners of boxes around the virtual objects, in the world; empty: unknown
/// @param covers_pixels  some of their surfaces are in the picture
Visibility visibility_of(CameraModel const& camera, gi::RigidPose const& world_from_camera,
                         std::vector<glm::dvec3> const& corners_m, bool covers_pixels);

} // namespace ar
