#include "viewer/app/layout.h"

#include "viewer/displays/blend.h"
#include "viewer/displays/compose.h"
#include "viewer/engine/live/desktop_views.h"

#include <algorithm>

namespace viewer {

Layout desktop_layout(ViewState const& state, StereoMode mode, std::span<glm::ivec2 const> window_px)
{
    glm::ivec2 const px = window_px[0], eye_px = eye_size(mode, px);
    Layout layout;
    layout.panes.resize(window_px.size());
    if (eye_px.x <= 0 || eye_px.y <= 0) return layout;
    layout.views = desktop_views(state.now(),
                                 {mode != StereoMode::off, state.settings.eye_distance_m, state.screen_distance_m},
                                 px, eye_px);
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

} // namespace

Layout display_layout(Display const& display, std::span<std::optional<RoomPose> const> heads,
                      gi::dmat4 const& world_from_room)
{
    Layout layout;
    layout.views = view_orders(views_of(display, heads), world_from_room);
    layout.panes = display_panes(display, layout.views);
    return layout;
}

std::vector<std::vector<Pane>> display_panes(Display const& display, std::span<ViewCommand const> views)
{
    std::vector<std::vector<Pane>> panes(display.windows.size());
    for (std::size_t w = 0; w < display.walls.size(); ++w) {
        Wall const& wall = display.walls[w];
        Pane pane;
        for (std::size_t k = 0; k < views.size(); ++k)
            if (is_of(views[k], wall)) (pane.left < 0 ? pane.left : pane.right) = int(k);
        if (pane.left < 0) continue;
        pane.stereo = wall.stereo;
        pane.of_wall = int(w);
        pane.wall = needs_finish(wall) ? int(w) : -1;
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
                s.mesh.vertices.push_back({glm::vec2(n.place), glm::vec2(n.picture), 1});
        }
        WallFrame const frame = wall_frame(wall.corners);
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
