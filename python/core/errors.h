#pragma once
// Errors of the Python module.

#include <pybind11/pybind11.h>

namespace bindings {

/// Registers the translation of C++ InputError and ScriptError to the exceptions of lightwell.errors.
void translate_errors();

/// Throws InputError unless low <= value <= high.
void check_range(char const* name, double value, double low, double high);

} // namespace bindings
