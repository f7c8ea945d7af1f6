#pragma once
#include <pybind11/pybind11.h>

namespace bindings {

/// Binds Script with its plans and sessions; read_journal, study_example.
void bind_study(pybind11::module_& m);

} // namespace bindings
