#pragma once
#include <pybind11/pybind11.h>

namespace bindings {

/// Script, with plans and sessions of it; read_journal, study_example.
void bind_study(pybind11::module_& m);

} // namespace bindings
