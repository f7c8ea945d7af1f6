#pragma once
#include <pybind11/pybind11.h>

namespace bindings {

/// From now on InputError and ScriptError of the program arrive in Python as those of lightwell.errors.
void translate_errors();

/// Throws InputError where a value is not between low and high, or not finite.
void check_range(char const* name, double value, double low, double high);

} // namespace bindings
