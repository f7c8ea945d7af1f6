#pragma once
// The displays of data/displays, embedded in the program: CMake fills examples.cpp.in.

#include <span>
#include <string_view>

namespace viewer {

struct DisplayExample {
    std::string_view name; ///< "cave4.yaml"; formats of other programs keep their extensions: "cave.pvx"
    std::string_view text;
};
std::span<DisplayExample const> display_examples();

} // namespace viewer
