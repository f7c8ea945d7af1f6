#pragma once
// GLFW, initialised once per process. It belongs to the main thread, where windows
// must be created, polled and closed.

#include <memory>

namespace viewer {

/// GLFW runs while any instance exists. Throws InputError if it cannot start (no display server).
std::shared_ptr<void const> glfw_library();
/// Returns and clears GLFW's last error in this thread, "no reason given" if there is none.
char const* glfw_error();

} // namespace viewer
