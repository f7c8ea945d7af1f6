#pragma once
#include "viewer/app/view_state.h"

namespace viewer {

/// Draws the contents of the panel, between Panel::begin and end. Every entry of the settings table appears here
/// automatically.
void fill_panel(ViewState& state, double frames_per_s);

} // namespace viewer
