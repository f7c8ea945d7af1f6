#include "viewer/displays/desktop_views.h"

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

namespace viewer {

std::vector<ViewCommand> desktop_views(gi::Camera const& middle, DesktopStereo const& stereo, glm::ivec2 window,
                                       glm::ivec2 size)
{
    if (!stereo.on || middle.orthographic) return {{"window", middle, window.x, window.y, -1}};
    std::vector<ViewCommand> views;
    double const top = std::tan(0.5 * middle.yfov_rad), right = top * window.x / window.y;
    for (double const side : {-1.0, 1.0}) {
        double const aside = 0.5 * side * stereo.eye_distance_m, shift = -aside / stereo.screen_distance_m;
        gi::Camera eye = middle;
        eye.world_from_camera = middle.world_from_camera * glm::translate(gi::dmat4(1), gi::dvec3{aside, 0, 0});
        eye.off_axis = gi::ViewTangents{-right + shift, right + shift, -top, top};
        views.push_back({side < 0 ? "left eye" : "right eye", eye, size.x, size.y, side < 0 ? -1 : 0});
    }
    return views;
}

} // namespace viewer
