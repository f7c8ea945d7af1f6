#pragma once
// The contents of the settings panel.

#include "viewer/app/view_state.h"

namespace viewer {

/// Notes on the frame: why it does not refine, what limits it, how it is exposed.
std::vector<std::string> frame_notes(ViewState const& state, LiveFrame const& frame);

enum class PanelPlace : std::uint8_t {
    over_picture, ///< at its left, over a third of the width at most
    alone         ///< the caller gives its size
};

/// Draws the contents of the panel, between Panel::begin and end. Every entry of the settings table appears here
/// automatically, if it has an effect now.
void fill_panel(ViewState& state, double frames_per_s, PanelPlace place);

} // namespace viewer
