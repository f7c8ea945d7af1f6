#pragma once
// Key figures of a display, for planning it.

#include "viewer/displays/views.h"

#include <vector>

namespace viewer {

struct ViewSummary {
    DisplayView view;
    double width_m = 0, height_m = 0;                    ///< of the wall
    double distance_m = 0;                               ///< of the eye from the wall's plane; negative behind it
    double horizontal_deg = 0, vertical_deg = 0;         ///< angles between opposite edges; 0 if it sees nothing
    double px_per_deg_across = 0, px_per_deg_upward = 0; ///< at the centre of the wall
};

/// Figures for the resting heads, in the order of views_of.
std::vector<ViewSummary> summarise_views(Display const& display);

} // namespace viewer
