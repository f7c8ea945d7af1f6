#pragma once
// Degrees of visual angle, centimetres and pixels of a flat screen that is seen from in front of its centre.

#include "study/display/display_model.h"

#include <array>

namespace study {

/// Pixels per centimetre, across and down.
std::pair<double, double> pixels_per_cm(ScreenGeometry const& screen);
/// Pixels per degree at the centre of the screen, across. NaN if the distance is unknown.
double pixels_per_degree(ScreenGeometry const& screen);
/// Length of something of this angle around the centre, px: 2 distance tan(angle / 2). @param deg  below 180
double px_of_size(ScreenGeometry const& screen, double deg, bool is_down);
/// Distance from the centre of a direction, px: distance tan(angle).
double px_of_place(ScreenGeometry const& screen, double deg, bool is_down);
/// Direction of a place, degrees from the centre. @param px  from the centre, to the right or down
double deg_of_place(ScreenGeometry const& screen, double px, bool is_down);
/// From the eyes to a place, of length 1: x to the right, y down, z into the screen. @param px  from the centre
std::array<double, 3> direction_of_place(ScreenGeometry const& screen, std::pair<double, double> px);
/// Angle between the directions of two places, degrees. @param a, b  from the centre, px (x to the right, y down)
double deg_between(ScreenGeometry const& screen, std::pair<double, double> a, std::pair<double, double> b);
/// Angles that the whole screen takes, across and down.
std::pair<double, double> screen_deg(ScreenGeometry const& screen);

} // namespace study
