#pragma once
#include <pybind11/pybind11.h>

namespace bindings {

/// Frames, the renderer of frames that follow each other.
void bind_frames(pybind11::module_& m);

} // namespace bindings
