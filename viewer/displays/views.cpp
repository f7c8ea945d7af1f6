#include "viewer/displays/views.h"

#include <algorithm>

namespace viewer {
namespace {

DisplayView view_of(Display const& d, int wall_index, Eye eye, WallFrame const& frame, Eyes const& eyes)
{
    Wall const& wall = d.walls[std::size_t(wall_index)];
    gi::dvec3 const from = eye == Eye::left ? eyes.left : eye == Eye::right ? eyes.right : eyes.middle;
    PixelRectangle const area = viewport_px(wall, d.windows[std::size_t(wall.window)]);
    DisplayView view;
    view.wall = wall_index;
    view.eye = eye;
    view.name = wall.name + ", " + name_of(eye) + (eye == Eye::middle ? "" : " eye");
    view.width_px = std::max(1, area.width / (wall.stereo == StereoMode::side_by_side ? 2 : 1));
    view.height_px = std::max(1, area.height / (wall.stereo == StereoMode::top_bottom ? 2 : 1));
    if (wall.render_width_px > 0) {
        view.width_px = wall.render_width_px;
        view.height_px = wall.render_height_px;
    }
    view.place = place_of(from, frame);
    view.camera = off_axis_camera(from, frame);
    if (view.camera) view.camera->name = view.name;
    return view;
}

} // namespace

char const* name_of(Eye eye) { return eye == Eye::left ? "left" : eye == Eye::right ? "right" : "middle"; }

Eyes eyes_of(User const& user, RoomPose const& head)
{
    gi::dvec3 const middle = head.position + head.rotation * user.eye_offset_m;
    gi::dvec3 const half = head.rotation * gi::dvec3{0.5 * user.interpupillary_m, 0, 0};
    return {middle - half, middle + half, middle};
}

RoomPose resting_head(User const& user) { return pose_of(user.head); }

std::vector<DisplayView> views_of(Display const& d, std::span<std::optional<RoomPose> const> heads, int rank)
{
    std::vector<DisplayView> views;
    for (std::size_t w = 0; w < d.walls.size(); ++w) {
        Wall const& wall = d.walls[w];
        if (rank >= 0 && wall.rank != rank) continue;
        auto const u = std::size_t(wall.user);
        bool const is_tracked = u < heads.size() && heads[u];
        Eyes const eyes = eyes_of(d.users[u], is_tracked ? *heads[u] : resting_head(d.users[u]));
        WallFrame const frame = wall_frame(wall.corners);
        if (wall.stereo == StereoMode::off) {
            views.push_back(view_of(d, int(w), Eye::middle, frame, eyes));
            continue;
        }
        int const first = int(views.size());
        views.push_back(view_of(d, int(w), wall.swap_eyes ? Eye::right : Eye::left, frame, eyes));
        views.push_back(view_of(d, int(w), wall.swap_eyes ? Eye::left : Eye::right, frame, eyes));
        views.back().partner = first;
    }
    return views;
}

std::vector<ViewCommand> view_orders(std::span<DisplayView const> views, gi::dmat4 const& world_from_room,
                                     std::vector<int>* sources)
{
    std::vector<ViewCommand> orders;
    std::vector<int> order_of(views.size(), -1);
    for (std::size_t i = 0; i < views.size(); ++i) {
        DisplayView const& view = views[i];
        if (!view.camera) continue;
        ViewCommand order{view.name, *view.camera, view.width_px, view.height_px, -1};
        gi::dmat4& m = order.camera.world_from_camera;
        m = world_from_room * m;
        // Directions must not depend on the user's scale.
        for (int axis = 0; axis < 3; ++axis) m[axis] = glm::dvec4(glm::normalize(gi::dvec3(m[axis])), 0);
        if (view.partner >= 0) order.partner = order_of[std::size_t(view.partner)];
        order_of[i] = int(orders.size());
        if (sources) sources->push_back(int(i));
        orders.push_back(order);
    }
    return orders;
}

} // namespace viewer
