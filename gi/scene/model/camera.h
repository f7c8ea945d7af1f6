#pragma once
// Cameras look along -Z of their frame, +Y up, +X right (glTF). Perspective cameras may have a thin lens (Potmesil
// and Chakravarty 1981): every point of the lens disk sees the plane in focus as its centre does, and a point at
// depth d is blurred to a disk of diameter 2 r |d - f| / d in that plane.

#include "gi/core/math.h"

#include <optional>
#include <string>

namespace gi {

/// Edges of an off-axis view, as tangents of the angles to the axis: at distance d the view extends from
/// (left, bottom) d to (right, top) d. left < right and bottom < top; the intervals need not contain 0.
struct ViewTangents {
    double left = 0, right = 0, bottom = 0, top = 0;

    bool operator==(ViewTangents const&) const = default;
};

struct Camera {
    std::string name;
    bool orthographic = false;
    double yfov_rad = 0.8;                ///< perspective: full vertical field of view
    std::optional<ViewTangents> off_axis; ///< replaces the field of view; pictures of any size fill it
    double ymag_m = 1;                    ///< orthographic: half the height of the view
    double aspect = 0; ///< width / height stated in the file, 0 = none; only for saving, pictures use --size
    double aperture_radius_m = 0; ///< of the lens; 0 = a pinhole, with all depths in focus
    double focus_distance_m = 0;  ///< along the axis, to the plane in focus; used only with a lens
    dmat4 world_from_camera{1};

    bool operator==(Camera const&) const = default;
};

/// Limits that keep the squares of derived values within the range of a float.
inline constexpr double kWidestLens_m = 1e6, kNearestFocus_m = 1e-6, kFarthestFocus_m = 1e9;

struct Ray {
    vec3 origin;
    vec3 direction; ///< unit
};

/// A camera prepared for a picture of width x height pixels; plain data for kernels. Frame: World (see world.h).
struct CameraRays {
    vec3 origin, corner, step_x, step_y,
        forward;               ///< corner: direction (or origin offset) of pixel position (0, 0)
    vec3 lens_x{0}, lens_y{0}; ///< lens radius times the camera's right and up directions, m
    float focus = 0;           ///< m along forward; 0 = a pinhole
    bool orthographic;

    GI_FN bool has_lens() const { return focus > 0; }
    /// Returns the pinhole camera at a point of the lens (given in the unit disk);
    /// it has the same view of the plane in focus.
    GI_FN CameraRays at_lens(vec2 disk) const
    {
        CameraRays rays = *this;
        vec3 const aside = disk.x * lens_x + disk.y * lens_y;
        rays.origin += aside;
        rays.corner -= aside / focus;
        rays.lens_x = rays.lens_y = vec3{0};
        rays.focus = 0;
        return rays;
    }

    /// Returns the ray through pixel position p, in pixels with (0, 0) at the top left corner of the picture, and
    /// the centre of the lens.
    GI_FN Ray through(vec2 p) const
    {
        vec3 const v = corner + p.x * step_x + p.y * step_y;
        if (orthographic) return {origin + v, forward};
        return {origin, glm::normalize(v)};
    }
};

/// The edges of a picture of width x height pixels: tangents, or m for an orthographic camera.
ViewTangents view_edges(Camera const& camera, int width, int height);

/// Prepares a camera. The vertical field of view is kept and the horizontal one follows from width / height; an
/// off-axis view fixes both. Positions are relative to world_origin. Throws InputError as check_lens does.
CameraRays camera_rays(Camera const& camera, int width, int height, dvec3 world_origin);
/// Throws InputError if the radius or the focus distance is negative or not finite, if the lens focuses at 0, or
/// if an orthographic camera has a lens.
void check_lens(Camera const& camera);
/// Returns a camera at `from` looking at `at`, +Y up (any other up if one is vertically above the other).
/// Throws InputError if from == at or a value is not finite.
Camera look_at(dvec3 from, dvec3 at, double yfov_deg);

} // namespace gi
