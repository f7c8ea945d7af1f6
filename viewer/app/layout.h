#pragma once
// Which views a frame has, and where in which window each is shown: a desktop's window, or the walls of a display.

#include "viewer/app/presenter.h"
#include "viewer/app/view_state.h"
#include "viewer/displays/views.h"

namespace viewer {

struct Layout {
    std::vector<ViewCommand> views;
    std::vector<std::vector<Pane>> panes; ///< per window
};

/// One window, or two with StereoMode::two_windows. @param window_px  of each; nothing of a size of 0 is rendered
/// @param mode  that the windows can show
Layout desktop_layout(ViewState const& state, StereoMode mode, std::span<glm::ivec2 const> window_px);

/// All walls. Those that no eye sees, and windows of a size of 0, have no views.
Layout display_layout(Display const& display, std::span<std::optional<RoomPose> const> heads,
                      gi::dmat4 const& world_from_room);
/// Panes for views that were made by display_layout, here or by another process: by their names.
std::vector<std::vector<Pane>> display_panes(Display const& display, std::span<ViewCommand const> views);
/// Of these views, those of the walls of a rank.
std::vector<ViewCommand> views_of_rank(Display const& display, std::span<ViewCommand const> views, int rank);

/// What the passes of the walls are made with: one per wall.
std::vector<WallSettings> wall_settings(Display const& display);
/// Windows that a rank draws; -1 = all.
std::vector<int> windows_of(Display const& display, int rank);

} // namespace viewer
