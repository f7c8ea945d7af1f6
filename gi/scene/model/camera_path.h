#pragma once
// Camera path: position, rotation and field of view interpolated between keys.
//
// Positions follow cubic Hermite curves whose velocity at a key is that of the parabola through the key and its
// neighbours (Catmull-Rom for non-uniform keys), so positions and velocities are continuous, and keys on a
// parabola are interpolated along it. Rotations follow the Hermite curve of unit quaternions (Kim, Kim and Shin
// 1995, "A General Construction Scheme for Unit Quaternion Curves with Simple High Order Derivatives", section 4),
// whose angular velocity is continuous even for non-uniform keys, unlike that of squad. Rotations take the shorter
// way round. Fields of view change smoothly in log tan(fov / 2) and stay between those of the two keys.
// The camera is at rest before the first key and after the last.

#include "gi/scene/model/camera.h"

#include <optional>
#include <vector>

namespace gi {

struct CameraKey {
    double time_s = 0;
    dvec3 from{0};                 ///< m
    dquat rotation{1, 0, 0, 0};    ///< unit, world from camera; if `at` is given, looks at it
    std::optional<dvec3> at;       ///< m, differs from `from`
    std::optional<double> fov_rad; ///< vertical
};

struct CameraPath {
    std::vector<CameraKey> keys; ///< at least one, in increasing time; either all or none have a field of view
};

/// Returns the camera at a time. If all keys have `at`, that point is interpolated as `from` is and the camera
/// looks at it with +Y up; otherwise rotations are interpolated.
/// @param fov_rad used if the keys have no field of view
/// Throws InputError if the two points coincide between keys.
Camera camera_at(CameraPath const& path, double time_s, double fov_rad);

} // namespace gi
