#include "viewer/displays/views.h"

#include <algorithm>
#include <cmath>

namespace viewer {
namespace {

gi::dvec3 place_of_eye(Eyes const& eyes, Eye eye)
{
    return eye == Eye::left ? eyes.left : eye == Eye::right ? eyes.right : eyes.middle;
}

std::string name_of_view(Wall const& wall, Eye eye)
{
    return wall.name + ", " + name_of(eye) + (eye == Eye::middle ? "" : " eye");
}

/// Size of one eye's picture in the viewport.
glm::ivec2 eye_px(Display const& d, Wall const& wall)
{
    PixelRectangle const area = viewport_px(wall, d.windows[std::size_t(wall.window)]);
    return {std::max(1, area.width / (wall.stereo == StereoMode::side_by_side ? 2 : 1)),
            std::max(1, area.height / (wall.stereo == StereoMode::top_bottom ? 2 : 1))};
}

DisplayView flat_view(Display const& d, int wall_index, Eye eye, WallFrame const& frame, Eyes const& eyes)
{
    Wall const& wall = d.walls[std::size_t(wall_index)];
    gi::dvec3 const from = place_of_eye(eyes, eye);
    glm::ivec2 const px = eye_px(d, wall);
    DisplayView view;
    view.wall = wall_index;
    view.eye = eye;
    view.name = name_of_view(wall, eye);
    view.width_px = px.x;
    view.height_px = px.y;
    if (wall.render_width_px > 0) {
        view.width_px = wall.render_width_px;
        view.height_px = wall.render_height_px;
    }
    view.place = place_of(from, frame);
    view.camera = off_axis_camera(from, frame);
    if (view.camera) view.camera->name = view.name;
    return view;
}

void add_faces(std::vector<DisplayView>& views, Display const& d, int wall_index, std::span<FaceView const> faces,
               Eye eye, Eyes const& eyes)
{
    Wall const& wall = d.walls[std::size_t(wall_index)];
    gi::dvec3 const from = place_of_eye(eyes, eye);
    bool const is_finite = std::isfinite(glm::dot(from, from));
    for (FaceView const& face : faces) {
        DisplayView view;
        view.wall = wall_index;
        view.eye = eye;
        view.face = face.face;
        view.name = name_of_view(wall, eye) + ", " + name_of(face.face) + " face";
        view.width_px = face.width_px;
        view.height_px = face.height_px;
        view.place = is_finite ? EyePlace::before : EyePlace::unknown;
        if (is_finite) {
            view.camera = face_camera(*wall.surface, face, from);
            view.camera->name = view.name;
        }
        views.push_back(std::move(view));
    }
}

/// The earlier view of the other eye on a wall of the same place, where each eye has its own projector.
int partner_of(std::span<DisplayView const> views, Display const& d, Wall const& wall, DisplayView const& view)
{
    Eye const other = view.eye == Eye::left ? Eye::right : Eye::left;
    for (std::size_t i = 0; i < views.size(); ++i) {
        Wall const& w = d.walls[std::size_t(views[i].wall)];
        if (views[i].eye == other && w.eye != Eye::middle && w.corners == wall.corners && !w.surface &&
            w.user == wall.user && w.rank == wall.rank && views[i].width_px == view.width_px &&
            views[i].height_px == view.height_px)
            return int(i);
    }
    return -1;
}

} // namespace

Eyes eyes_of(User const& user, RoomPose const& head)
{
    gi::dvec3 const middle = head.position + head.rotation * user.eye_offset_m;
    gi::dvec3 const half = head.rotation * gi::dvec3{0.5 * user.interpupillary_m, 0, 0};
    return {middle - half, middle + half, middle};
}

RoomPose resting_head(User const& user) { return pose_of(user.head); }

std::vector<FaceView> faces_of(Display const& d, Wall const& wall)
{
    constexpr double kReach_m = 1,
                     kShare = 0.5; // how far a tracked head goes, and at most this share of the radius
    User const& user = d.users[std::size_t(wall.user)];
    gi::dvec3 const rest = eyes_of(user, resting_head(user)).middle;
    std::vector<gi::dvec3> eyes{rest};
    double const reach = user.tracker < 0 ? 0.1 : kReach_m;
    double const far = std::min(reach, kShare * distance_of(*wall.surface, rest));
    if (far > 0)
        for (int corner = 0; corner < 8; ++corner)
            eyes.push_back(rest + far * gi::dvec3{corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1});
    return faces_for(*wall.surface, eye_px(d, wall), eyes, wall.render_width_px);
}

std::vector<DisplayView> views_of(Display const& d, std::span<std::optional<RoomPose> const> heads, int rank)
{
    std::vector<DisplayView> views;
    for (std::size_t w = 0; w < d.walls.size(); ++w) {
        Wall const& wall = d.walls[w];
        if (rank >= 0 && wall.rank != rank) continue;
        auto const u = std::size_t(wall.user);
        bool const is_tracked = u < heads.size() && heads[u];
        Eyes const eyes = eyes_of(d.users[u], is_tracked ? *heads[u] : resting_head(d.users[u]));
        std::vector<Eye> shown{Eye::left, Eye::right};
        if (wall.stereo == StereoMode::off) shown = {wall.eye};
        if (wall.swap_eyes)
            for (Eye& eye : shown) eye = eye == Eye::left ? Eye::right : eye == Eye::right ? Eye::left : eye;
        std::vector<FaceView> const faces = wall.surface ? faces_of(d, wall) : std::vector<FaceView>();
        int const first = int(views.size());
        for (Eye const eye : shown) {
            std::size_t const before = views.size();
            if (wall.surface)
                add_faces(views, d, int(w), faces, eye, eyes);
            else
                views.push_back(flat_view(d, int(w), eye, wall_frame(wall.corners), eyes));
            if (int(before) > first)
                for (std::size_t k = before; k < views.size(); ++k) views[k].partner = first + int(k - before);
            else if (wall.eye != Eye::middle && !wall.surface)
                views.back().partner = partner_of({views.data(), before}, d, wall, views.back());
        }
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
