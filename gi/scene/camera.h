#pragma once
// Cameras look along -Z of their frame, +Y up, +X right (glTF).

#include "gi/base/math.h"

#include <string>

namespace gi {

struct Camera {
    std::string name;
    bool orthographic = false;
    double yfov_rad = 0.8; ///< perspective: full vertical field of view
    double ymag_m = 1;     ///< orthographic: half the height of the view
    double aspect = 0;     ///< width / height the file states, 0 = none; kept for saving, pictures follow --size
    dmat4 world_from_camera{1};

    bool operator==(Camera const&) const = default;
};

struct Ray {
    vec3 origin;
    vec3 direction; ///< unit
};

/// A camera made ready for a picture of width x height pixels; plain data for kernels. Frame: World (see world.h).
struct CameraRays {
    vec3 origin, corner, step_x, step_y,
        forward; ///< corner: direction (or origin offset) of pixel position (0, 0)
    bool orthographic;

    /// The ray through pixel position p in pixels, (0, 0) the top left corner of the picture.
    GI_FN Ray through(vec2 p) const
    {
        vec3 const v = corner + p.x * step_x + p.y * step_y;
        if (orthographic) return {origin + v, forward};
        return {origin, glm::normalize(v)};
    }
};

/// Vertical field of view is kept; the horizontal one follows width / height. Positions are relative to
/// world_origin.
CameraRays camera_rays(Camera const& camera, int width, int height, dvec3 world_origin);
/// Inverse of CameraRays::through for a point in the same frame: pixel position and depth along forward (m).
vec3 project(CameraRays const& camera, vec3 point);
/// A camera at `from` looking at `at`, +Y up (any other up if the two are vertical above each other).
/// Throws InputError if from == at or a value is not finite.
Camera look_at(dvec3 from, dvec3 at, double yfov_deg);

} // namespace gi
