#pragma once
// GLFW, started once for the process. It belongs to the main thread: windows are made, polled and closed there.

#include <memory>

namespace viewer {

/// Running as long as somebody holds it. Throws InputError where it cannot start (no display server).
std::shared_ptr<void const> glfw_library();
/// What GLFW last complained of in this thread, "no reason given" if nothing; forgets it.
char const* glfw_error();

} // namespace viewer
