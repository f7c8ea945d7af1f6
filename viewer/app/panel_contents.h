#pragma once
// The contents of the settings panel.

#include "viewer/app/view_state.h"

namespace viewer {

/// Notes on the frame: why it does not refine, what limits it, how it is exposed.
std::vector<std::string> frame_notes(ViewState const& state, LiveFrame const& frame);

/// Draws the contents of the panel, between Panel::begin and end. Every entry of the settings
/// table appears here automatically.
void fill_panel(ViewState& state, double frames_per_s);

} // namespace viewer
