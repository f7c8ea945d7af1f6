#include "viewer/app/layout.h"

#include "viewer/displays/blend.h"
#include "viewer/displays/compose.h"
#include "viewer/displays/desktop_views.h"

#include <algorithm>

namespace viewer {

Layout desktop_layout(ViewState const& state, StereoMode mode, std::span<glm::ivec2 const> window_px)
{
    glm::ivec2 const px = window_px[0], eye_px = eye_size(mode, px);
    Layout layout;
    layout.panes.resize(window_px.size());
    if (eye_px.x <= 0 || eye_px.y <= 0) return layout;
    layout.views = desktop_views(
        state.now(), {mode != StereoMode::off, state.settings().eye_distance_m, state.screen_distance_m}, px,
        eye_px);
    int const right = layout.views.size() > 1 ? 1 : -1;
    layout.panes[0] = {{{0, 0}, px, mode, 0, right}};
    if (window_px.size() > 1) layout.panes[1] = {{{0, 0}, window_px[1], mode, 0, right, true}};
    return layout;
}

namespace {

/// views_of names a view "wall" or "wall, left eye".
bool is_of(ViewCommand const& view, Wall const& wall)
{
    return view.name.starts_with(wall.name) &&
           (view.name.size() == wall.name.size() || view.name[wall.name.size()] == ',');
}

/// Puts the views of a wall that is not flat into the pane: those of the eye named first to the left.
void put_faces(Pane& pane, Wall const& wall, std::span<ViewCommand const> views, gi::dmat4 const& world_from_room)
{
    gi::dmat4 const room_from_world = glm::inverse(world_from_room);
    std::string first_eye;
    for (std::size_t k = 0; k < views.size(); ++k) {
        if (!is_of(views[k], wall)) continue;
        std::string const rest = views[k].name.substr(wall.name.size()); // ", left eye, front face"
        std::size_t const comma = rest.find(", ", 2);
        if (comma == std::string::npos) continue;
        std::string const eye = rest.substr(0, comma), face = rest.substr(comma + 2);
        if (first_eye.empty()) first_eye = eye;
        PaneFaces& faces = eye == first_eye ? pane.left_faces : pane.right_faces;
        for (CubeFace const f : kCubeFaces)
            if (face == std::string(name_of(f)) + " face") {
                faces.views.push_back(int(k));
                faces.faces.push_back(f);
                faces.eye_m = gi::dvec3(room_from_world * views[k].camera.world_from_camera[3]);
            }
    }
}

} // namespace

Layout display_layout(Display const& display, std::span<std::optional<RoomPose> const> heads,
                      gi::dmat4 const& world_from_room)
{
    Layout layout;
    layout.views = view_orders(views_of(display, heads), world_from_room);
    layout.panes = display_panes(display, layout.views, world_from_room);
    return layout;
}

std::vector<std::vector<Pane>> display_panes(Display const& display, std::span<ViewCommand const> views,
                                             gi::dmat4 const& world_from_room)
{
    std::vector<std::vector<Pane>> panes(display.windows.size());
    for (std::size_t w = 0; w < display.walls.size(); ++w) {
        Wall const& wall = display.walls[w];
        Pane pane;
        if (wall.surface) put_faces(pane, wall, views, world_from_room);
        for (std::size_t k = 0; k < views.size() && !wall.surface; ++k)
            if (is_of(views[k], wall)) (pane.left < 0 ? pane.left : pane.right) = int(k);
        if (pane.left < 0 && pane.left_faces.views.empty()) continue;
        pane.stereo = wall.stereo;
        pane.wall = wall.surface || needs_finish(wall) ? int(w) : -1;
        pane.of_wall = int(w);
        auto const add = [&](int window, bool right_alone) {
            PixelRectangle const r = viewport_px(wall, display.windows[std::size_t(window)]);
            if (r.width <= 0 || r.height <= 0) return;
            pane.corner_px = {r.x, r.y};
            pane.size_px = {r.width, r.height};
            pane.right_alone = right_alone;
            panes[std::size_t(window)].push_back(pane);
        };
        add(wall.window, false);
        if (wall.stereo == StereoMode::two_windows && wall.second_window >= 0) add(wall.second_window, true);
    }
    return panes;
}

std::vector<ViewCommand> views_of_rank(Display const& display, std::span<ViewCommand const> views, int rank)
{
    std::vector<ViewCommand> own;
    std::vector<int> index(views.size(), -1);
    for (std::size_t k = 0; k < views.size(); ++k) {
        auto const wall = std::find_if(display.walls.begin(), display.walls.end(),
                                       [&](Wall const& w) { return is_of(views[k], w); });
        if (wall == display.walls.end() || wall->rank != rank) continue;
        index[k] = int(own.size());
        own.push_back(views[k]);
        if (own.back().partner >= 0) own.back().partner = index[std::size_t(own.back().partner)];
    }
    return own;
}

std::vector<WallSettings> wall_settings(Display const& display)
{
    std::vector<WallSettings> all;
    for (Wall const& wall : display.walls) {
        WallSettings s;
        if (wall.warp) {
            s.mesh = {wall.warp->columns, wall.warp->rows, {}};
            for (WarpNode const& n : wall.warp->nodes)
                s.mesh.vertices.push_back({glm::vec2(n.place), glm::vec2(n.picture), float(n.weight)});
        }
        if (wall.warp_map) s.positions = wall.warp_map->map;
        if (wall.blend_picture) s.blend_map = wall.blend_picture->light.map;
        if (wall.black_level_picture) s.black_level = wall.black_level_picture->light.map;
        s.surface = wall.surface;
        WallFrame const frame = wall.surface ? WallFrame{{}, {}, {}, {}, 1, 1, 0} : wall_frame(wall.corners);
        WallBlend const& b = wall.blend;
        s.blend = {float(b.left_m / frame.width_m), float(b.right_m / frame.width_m),
                   float(b.bottom_m / frame.height_m), float(b.top_m / frame.height_m), float(b.power)};
        s.gain = glm::vec3(wall.gain);
        s.gamma = glm::vec3(float(wall.blend.gamma));
        all.push_back(std::move(s));
    }
    return all;
}

std::vector<int> windows_of(Display const& display, int rank)
{
    std::vector<int> windows;
    for (Wall const& wall : display.walls) {
        if (rank >= 0 && wall.rank != rank) continue;
        for (int const w : {wall.window, wall.second_window})
            if (w >= 0 && std::find(windows.begin(), windows.end(), w) == windows.end()) windows.push_back(w);
    }
    return windows;
}

} // namespace viewer
