#pragma once
// Where gaze stayed, as a picture: each fixation is a Gaussian of directions.

#include "study/display/display_model.h"

#include <array>
#include <vector>

namespace study {

struct HeatSource {
    double x_px = 0, y_px = 0; ///< from the centre of the screen
    double seconds = 0;
};

/// Seconds per square degree, row by row from the top left of the screen.
struct HeatMap {
    int width = 0, height = 0;
    std::vector<double> density;
    double most = 0;    ///< greatest density
    double outside = 0; ///< seconds of sources beside the screen; what of them falls on it counts
};

/// @param sd_deg  standard deviation of the Gaussian, above 0; beyond 5 of them it counts as 0   @param width  of the
/// map, in cells; its height is in the ratio of the screen's pixels
HeatMap heat_map(std::vector<HeatSource> const& sources, ScreenGeometry const& screen, double sd_deg, int width);

/// Black, red, yellow, white, each a third of the way; by the square root of a share, 0 to 1.
std::array<unsigned char, 3> heat_color(double share);
/// Bytes of RGBA, row by row: heat_color of the density's share of `most`. @param most  above 0
/// Alpha grows from 0 at nothing to 220 at a quarter of `most`, so that a picture beneath is seen where nobody looked.
std::vector<unsigned char> heat_colors(HeatMap const& map, double most);

} // namespace study
