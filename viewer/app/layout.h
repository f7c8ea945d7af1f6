#pragma once
// The views of a frame and their places in windows: a desktop window, or the walls of a display.

#include "viewer/app/presenter.h"
#include "viewer/app/view_state.h"
#include "viewer/displays/views.h"

namespace viewer {

struct Layout {
    std::vector<ViewCommand> views;
    std::vector<std::vector<Pane>> panes; ///< per window
};

/// Layout of one window, or of two with StereoMode::two_windows. @param window_px  size of each; windows of size 0
/// get no views  @param mode  supported by the windows
Layout desktop_layout(ViewState const& state, StereoMode mode, std::span<glm::ivec2 const> window_px);

/// Layout of all walls. Walls that no eye sees, and windows of size 0, get no views.
Layout display_layout(Display const& display, std::span<std::optional<RoomPose> const> heads,
                      gi::dmat4 const& world_from_room);
/// Panes for views made by display_layout, in this or another process; matches them by name.
std::vector<std::vector<Pane>> display_panes(Display const& display, std::span<ViewCommand const> views,
                                             gi::dmat4 const& world_from_room);
/// The views of a rank's walls.
std::vector<ViewCommand> views_of_rank(Display const& display, std::span<ViewCommand const> views, int rank);

/// Settings for the wall passes, one per wall.
std::vector<WallSettings> wall_settings(Display const& display);
/// Windows drawn by a rank; -1 = all.
std::vector<int> windows_of(Display const& display, int rank);

} // namespace viewer
