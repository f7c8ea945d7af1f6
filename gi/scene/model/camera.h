#pragma once
// Cameras look along -Z of their frame, +Y up, +X right (glTF). Perspective ones may have a thin lens in their
// place (Potmesil and Chakravarty 1981): every point of its disk sees the plane in focus as the middle does, and
// what lies at depth d is spread over a disk of diameter 2 r |d - f| / d in that plane.

#include "gi/core/math.h"

#include <optional>
#include <string>

namespace gi {

/// Edges of an off-axis view, as tangents of the angles to the axis: at distance d the view reaches from
/// (left, bottom) d to (right, top) d. left < right and bottom < top; they need not hold 0 between them.
struct ViewTangents {
    double left = 0, right = 0, bottom = 0, top = 0;

    bool operator==(ViewTangents const&) const = default;
};

struct Camera {
    std::string name;
    bool orthographic = false;
    double yfov_rad = 0.8;                ///< perspective: full vertical field of view
    std::optional<ViewTangents> off_axis; ///< in place of the field of view; pictures of any size fill it
    double ymag_m = 1;                    ///< orthographic: half the height of the view
    double aspect = 0; ///< width / height the file states, 0 = none; kept for saving, pictures follow --size
    double aperture_radius_m = 0; ///< of the lens; 0 = a pinhole, which sees all depths sharply
    double focus_distance_m = 0;  ///< along the axis, to the plane in focus; read where there is a lens
    dmat4 world_from_camera{1};

    bool operator==(Camera const&) const = default;
};

/// So that squares of what is computed from them fit a float.
inline constexpr double kWidestLens_m = 1e6, kNearestFocus_m = 1e-6, kFarthestFocus_m = 1e9;

struct Ray {
    vec3 origin;
    vec3 direction; ///< unit
};

/// A camera made ready for a picture of width x height pixels; plain data for kernels. Frame: World (see world.h).
struct CameraRays {
    vec3 origin, corner, step_x, step_y,
        forward;               ///< corner: direction (or origin offset) of pixel position (0, 0)
    vec3 lens_x{0}, lens_y{0}; ///< radii of the lens
    float focus = 0;           ///< m along forward; 0 = a pinhole
    bool orthographic;

    GI_FN bool has_lens() const { return focus > 0; }
    /// The pinhole camera at a point of the lens, in the unit disk, that sees the plane in focus as this one does.
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

    /// The ray through pixel position p in pixels, (0, 0) the top left corner of the picture, and the middle of
    /// the lens.
    GI_FN Ray through(vec2 p) const
    {
        vec3 const v = corner + p.x * step_x + p.y * step_y;
        if (orthographic) return {origin + v, forward};
        return {origin, glm::normalize(v)};
    }
};

/// Vertical field of view is kept; the horizontal one follows width / height, or both are those of an off-axis
/// view. Positions are relative to world_origin. Throws InputError on a lens that check_lens refuses.
CameraRays camera_rays(Camera const& camera, int width, int height, dvec3 world_origin);
/// Throws InputError on a radius or a distance that is negative or not finite, a lens that focuses at 0, and one
/// of an orthographic camera.
void check_lens(Camera const& camera);
/// A camera at `from` looking at `at`, +Y up (any other up if the two are vertical above each other).
/// Throws InputError if from == at or a value is not finite.
Camera look_at(dvec3 from, dvec3 at, double yfov_deg);

} // namespace gi
