#pragma once
#include <pybind11/pybind11.h>

namespace bindings {

/// Binds Frames, which renders sequences of frames.
void bind_frames(pybind11::module_& m);

} // namespace bindings
