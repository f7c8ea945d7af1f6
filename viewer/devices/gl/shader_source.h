#pragma once
// The files of shaders/, which are part of the program: nothing is looked for when it runs.

#include <string_view>

namespace viewer {

/// By the name without the folder ("display.frag"); empty = there is none. Made by cmake/embed_shaders.cmake.
std::string_view shader_source(std::string_view file);

} // namespace viewer
