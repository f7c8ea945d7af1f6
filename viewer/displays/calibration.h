#pragma once
// Pictures for setting a display up, as pure functions of it: what to look at is said of each pattern.

#include "viewer/displays/views.h"

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace viewer {

enum class CalibrationPattern {
    grid,    ///< lines in metres of the wall, a circle in its middle: sizes, aspect, edges, joints with neighbours
    corners, ///< each corner in its colour with its name and place: which wall is which, what is up
    eyes,    ///< the eye's letter, and marks before, on and behind the wall: separation, swapped eyes
    colours, ///< bars, a ramp of grey, and lines that look as bright as the patch of gamma 2.2
    crosstalk, ///< fields black or white for one eye only: what leaks into the other
    blend,     ///< white, faded and coloured as the wall's blend and gain say: the overlap should be even
};
inline constexpr std::array kCalibrationPatterns = {CalibrationPattern::grid,      CalibrationPattern::corners,
                                                    CalibrationPattern::eyes,      CalibrationPattern::colours,
                                                    CalibrationPattern::crosstalk, CalibrationPattern::blend};
char const* name_of(CalibrationPattern pattern);
std::optional<CalibrationPattern> calibration_pattern(std::string_view name);

/// Display-encoded, three bytes a pixel, rows from the top.
struct CalibrationPicture {
    int width = 0, height = 0;
    std::vector<unsigned char> rgb;
};

/// What one eye sees on one wall, of the view's size. A view without a camera gets the patterns that need none;
/// `eyes` then says so in its picture.
CalibrationPicture draw_calibration(CalibrationPattern pattern, Display const& display, DisplayView const& view);

/// Distance between lines so that there are 6 to 24 along the longer edge: 1, 2 or 5 times a power of ten, m.
double grid_step_m(WallFrame const& wall);

} // namespace viewer
