#include "viewer/displays/view_summary.h"

namespace viewer {
namespace {

double angle_deg(gi::dvec3 a, gi::dvec3 b)
{
    return glm::degrees(std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)));
}

} // namespace

std::vector<ViewSummary> summarise_views(Display const& display)
{
    std::vector<ViewSummary> out;
    for (DisplayView const& view : views_of(display, {})) {
        Wall const& wall = display.walls[std::size_t(view.wall)];
        if (wall.surface) {
            gi::ViewTangents const t = *view.camera->off_axis;
            double const at_middle = glm::radians(1.0) * view.width_px / (t.right - t.left);
            gi::dvec3 const eye(view.camera->world_from_camera[3]);
            out.push_back({view, 0, 0, distance_of(*wall.surface, eye),
                           glm::degrees(std::atan(t.right) - std::atan(t.left)),
                           glm::degrees(std::atan(t.top) - std::atan(t.bottom)), at_middle, at_middle});
            continue;
        }
        WallFrame const frame = wall_frame(wall.corners);
        User const& user = display.users[std::size_t(wall.user)];
        Eyes const eyes = eyes_of(user, resting_head(user));
        gi::dvec3 const eye = view.eye == Eye::left    ? eyes.left
                              : view.eye == Eye::right ? eyes.right
                                                       : eyes.middle;
        ViewSummary s{view, frame.width_m, frame.height_m, glm::dot(eye - frame.lower_left, frame.normal), 0, 0, 0,
                      0};
        if (view.camera) {
            gi::ViewTangents const t = *view.camera->off_axis;
            s.horizontal_deg = glm::degrees(std::atan(t.right) - std::atan(t.left));
            s.vertical_deg = glm::degrees(std::atan(t.top) - std::atan(t.bottom));
            double const du = 0.5 / view.width_px, dv = 0.5 / view.height_px;
            auto const to = [&](double u, double v) { return frame.point(u, v) - eye; };
            s.px_per_deg_across = 1 / angle_deg(to(0.5 - du, 0.5), to(0.5 + du, 0.5));
            s.px_per_deg_upward = 1 / angle_deg(to(0.5, 0.5 - dv), to(0.5, 0.5 + dv));
        }
        out.push_back(std::move(s));
    }
    return out;
}

} // namespace viewer
