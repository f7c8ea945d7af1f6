#pragma once
// The paths of data/moving, embedded in the program: CMake fills recorded_paths.cpp.in.

#include <span>
#include <string_view>

namespace viewer {

struct RecordedPath {
    std::string_view name, csv;
};
std::span<RecordedPath const> recorded_paths();

} // namespace viewer
