#pragma once
#include <pybind11/pybind11.h>

namespace bindings {

/// methods, render.
void bind_render(pybind11::module_& m);

} // namespace bindings
