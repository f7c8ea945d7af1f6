#pragma once
// Where gaze may have been, given how accurate an eye tracker is.

#include "study/display/display_model.h"

#include <vector>

namespace study {

/// The same angle away from a direction, in another direction around it.
struct GazeOffset {
    double deg = 0, around_rad = 0;
};
/// Offsets of equal weight that follow a Gaussian of two dimensions: rings at the quantiles of its radius (Rayleigh),
/// turned by the golden angle. @param sd_deg  of each axis; 0 = all are at the middle   @param count  at least 1
std::vector<GazeOffset> gaussian_offsets(double sd_deg, int count);

/// The place on the screen whose direction is so far from that of another. @param place_px  from the centre
/// @return none: the direction misses the screen's plane
std::optional<std::pair<double, double>>
offset_place(ScreenGeometry const& screen, std::pair<double, double> place_px, GazeOffset const& offset);

} // namespace study
