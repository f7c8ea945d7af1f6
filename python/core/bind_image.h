#pragma once
#include <pybind11/pybind11.h>

namespace bindings {

/// compare, flip, tone_map, read_picture, write_exr, write_png.
void bind_image(pybind11::module_& m);

} // namespace bindings
