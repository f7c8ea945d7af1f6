#pragma once
// A camera that moves through keys: where it is and where it looks at any time between them.
//
// Positions follow cubic Hermite curves whose velocity at a key is that of the parabola through it and its
// neighbours (Catmull-Rom for keys of uneven distance), so they and their velocity are continuous and keys on a
// parabola are joined by it. Rotations follow the Hermite curve of unit quaternions (Kim, Kim and Shin 1995, "A
// General Construction Scheme for Unit Quaternion Curves with Simple High Order Derivatives", section 4), whose
// angular velocity is continuous for uneven keys too, as that of squad is not. The shorter way round is taken.
// Fields of view change smoothly in log tan(fov / 2) and stay between those of the two keys.
// Before the first key and after the last the camera rests.

#include "gi/scene/model/camera.h"

#include <optional>
#include <vector>

namespace gi {

struct CameraKey {
    double time_s = 0;
    dvec3 from{0};                 ///< m
    dquat rotation{1, 0, 0, 0};    ///< unit, world from camera; where `at` is given, the one that looks there
    std::optional<dvec3> at;       ///< m, differs from `from`
    std::optional<double> fov_rad; ///< vertical
};

struct CameraPath {
    std::vector<CameraKey> keys; ///< at least one, in increasing time; a field of view in all of them or in none
};

/// The camera at a time. Where all keys have `at`, that point moves as `from` does and the camera looks at it
/// with +Y up; else rotations are interpolated.
/// @param fov_rad where the keys have none
/// Throws InputError where the two points meet between keys.
Camera camera_at(CameraPath const& path, double time_s, double fov_rad);

} // namespace gi
