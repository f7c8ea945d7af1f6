#pragma once
// Test patterns for setting up a display, computed from its description alone.
// Each pattern's comment lists what to check.

#include "viewer/displays/views.h"

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace viewer {

enum class TestPattern {
    grid,      ///< lines at metric distances, a circle in the centre: sizes, aspect, edges, joints with neighbours
    corners,   ///< each corner with its colour, name and position: identity and orientation of the wall
    eyes,      ///< the eye's letter, and marks in front of, on and behind the wall: eye separation, swapped eyes
    colours,   ///< colour bars, grey ramp, and lines as bright as the patch at gamma 2.2
    crosstalk, ///< fields that are black or white for one eye only: leakage into the other eye
    blend,     ///< white with the wall's blend and gain applied: the overlap should be even
};
inline constexpr std::array kTestPatterns = {TestPattern::grid,    TestPattern::corners,   TestPattern::eyes,
                                             TestPattern::colours, TestPattern::crosstalk, TestPattern::blend};
char const* name_of(TestPattern pattern);
std::optional<TestPattern> test_pattern(std::string_view name);

/// Display-encoded, three bytes per pixel, rows from the top.
struct PatternPicture {
    int width = 0, height = 0;
    std::vector<unsigned char> rgb;
};

/// Picture of a wall that is not flat, of its viewport's size: lines of azimuth and elevation in the surface's
/// frame every 10 degrees, white every 30, green at azimuth 0, yellow at elevation 0; dark where nothing is lit.
PatternPicture draw_curved_grid(Display const& display, Wall const& wall);

/// Picture for one eye on one flat wall, of the view's size. Without a camera, only patterns that need none are
/// drawn; `eyes` then shows a message.
PatternPicture draw_pattern(TestPattern pattern, Display const& display, DisplayView const& view);

/// Distance between grid lines for 6 to 24 lines along the longer edge: 1, 2 or 5 times a power of ten, m.
double grid_step_m(WallFrame const& wall);

} // namespace viewer
