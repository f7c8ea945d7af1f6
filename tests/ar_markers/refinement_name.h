#pragma once
// Names of the ways to refine marker corners, for test names.

#include "ar/markers/aruco.h"

#include <array>
#include <string>

namespace ar::test {

inline std::string name_of(Refinement refinement)
{
    constexpr std::array<char const*, 5> names{"none", "edges", "subpixel", "contour", "apriltag"};
    return names[std::size_t(refinement)];
}

} // namespace ar::test
