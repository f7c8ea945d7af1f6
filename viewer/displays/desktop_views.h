#pragma once
// The views of a desktop window: one, or two for stereo.

#include "viewer/protocol/frame_command.h"

namespace viewer {

/// Stereo on a desktop without a display file: the window is a virtual screen at the distance
/// where both eyes' pictures coincide.
struct DesktopStereo {
    bool on = false;
    double eye_distance_m = 0.063;
    double screen_distance_m = 1; ///< > 0; points at this distance have no disparity
};

/// Returns one view for both eyes, or a left and a right view with off-axis frusta that share the screen. Each eye
/// sees the whole screen; in half a window its picture is squeezed, and the display stretches it again. An
/// orthographic camera has one view, with the window's pixels, whose aspect gives its width.
/// @param middle  camera between the eyes, symmetric
/// @param window, eye  size of the window and of one eye's picture, pixels
std::vector<ViewCommand> desktop_views(gi::Camera const& middle, DesktopStereo const& stereo, glm::ivec2 window,
                                       glm::ivec2 eye);

} // namespace viewer
