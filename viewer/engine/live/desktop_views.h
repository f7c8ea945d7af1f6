#pragma once
#include "viewer/protocol/frame_command.h"

namespace viewer {

/// Two eyes before a desktop, without a description of it: the window is a virtual screen at the distance where
/// both eyes' pictures coincide.
struct DesktopStereo {
    bool on = false;
    double eye_distance_m = 0.063;
    double screen_distance_m = 1; ///< > 0; what lies there has no disparity
};

/// One view for both eyes, or the left and the right one, whose frusta are off-axis so that they share the screen.
/// Each eye has the whole view, however few pixels: in halves of a window it is squeezed, as displays stretch it.
/// An orthographic camera has one view, of the window's pixels, which say how wide it is.
/// @param middle  camera between the eyes, symmetric   @param window, eye  of the whole and of one picture, pixels
std::vector<ViewCommand> desktop_views(gi::Camera const& middle, DesktopStereo const& stereo, glm::ivec2 window,
                                       glm::ivec2 eye);

} // namespace viewer
