#pragma once
#include "viewer/app/view_state.h"

namespace viewer {

/// Between Panel::begin and end: what can be seen and set. Every setting has its place here by its entry in the
/// table of settings.
void fill_panel(ViewState& state, double frames_per_s);

} // namespace viewer
