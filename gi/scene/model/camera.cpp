#include "gi/scene/model/camera.h"

#include "gi/core/error.h"

#include <fmt/format.h>

namespace gi {

ViewTangents view_edges(Camera const& camera, int width, int height)
{
    double const y = camera.orthographic ? camera.ymag_m : std::tan(0.5 * camera.yfov_rad), x = y * width / height;
    return camera.off_axis.value_or(ViewTangents{-x, x, -y, y});
}

CameraRays camera_rays(Camera const& camera, int width, int height, dvec3 world_origin)
{
    dmat4 const& m = camera.world_from_camera;
    dvec3 const right(m[0]), up(m[1]), back(m[2]), position(m[3]);
    ViewTangents const edge = view_edges(camera, width, height);
    CameraRays rays;
    rays.orthographic = camera.orthographic;
    rays.origin = vec3(position - world_origin);
    rays.forward = vec3(-back);
    rays.step_x = vec3(right * ((edge.right - edge.left) / width));
    rays.step_y = vec3(-up * ((edge.top - edge.bottom) / height));
    rays.corner = vec3((camera.orthographic ? dvec3{0} : -back) + edge.left * right + edge.top * up);
    if (camera.aperture_radius_m == 0) return rays;
    check_lens(camera);
    rays.lens_x = vec3(camera.aperture_radius_m * right);
    rays.lens_y = vec3(camera.aperture_radius_m * up);
    rays.focus = float(camera.focus_distance_m);
    return rays;
}

void check_lens(Camera const& camera)
{
    double const radius = camera.aperture_radius_m, focus = camera.focus_distance_m;
    if (!(radius >= 0 && radius <= kWidestLens_m))
        throw InputError(fmt::format("the aperture radius is {} m", radius),
                         fmt::format("it must be 0 to {:g} m", kWidestLens_m), "give its radius in metres, or 0");
    if (radius == 0) return;
    if (camera.orthographic)
        throw InputError("the orthographic camera '" + camera.name + "' has an aperture",
                         "its rays do not pass through one point",
                         "choose a perspective camera, or a radius of 0");
    if (!(focus >= kNearestFocus_m && focus <= kFarthestFocus_m))
        throw InputError(fmt::format("the focus distance is {} m", focus),
                         fmt::format("the plane in focus must be {:g} to {:g} m from the lens", kNearestFocus_m,
                                     kFarthestFocus_m),
                         "give the distance along the view in metres");
}

Camera look_at(dvec3 from, dvec3 at, double yfov_deg)
{
    dvec3 const back = from - at;
    double const length = glm::length(back);
    if (!(length > 0) || !std::isfinite(length) || !std::isfinite(glm::length(from)))
        throw InputError("the camera has no direction", "it looks at its own position or a value is not finite",
                         "give two different points");
    if (!(yfov_deg > 0) || !(yfov_deg < 180))
        throw InputError("the field of view is not between 0 and 180 degrees",
                         "a perspective camera needs an opening angle", "45 is a usual value");
    Camera camera;
    camera.yfov_rad = glm::radians(yfov_deg);
    dvec3 const z = back / length;
    dvec3 const up = std::abs(z.y) < 1 - 1e-12 ? dvec3{0, 1, 0} : dvec3{0, 0, 1};
    dvec3 const x = glm::normalize(glm::cross(up, z));
    camera.world_from_camera =
        dmat4(glm::dvec4(x, 0), glm::dvec4(glm::cross(z, x), 0), glm::dvec4(z, 0), glm::dvec4(from, 1));
    return camera;
}

} // namespace gi
