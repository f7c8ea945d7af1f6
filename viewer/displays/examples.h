#pragma once
// The displays of data/displays, carried by the program: examples.cpp.in is filled by CMake.

#include <span>
#include <string_view>

namespace viewer {

struct DisplayExample {
    std::string_view name; ///< "cave4.yaml"; those of other programs have their ends: "cave.pvx"
    std::string_view text;
};
std::span<DisplayExample const> display_examples();

} // namespace viewer
