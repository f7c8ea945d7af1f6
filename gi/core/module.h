#pragma once
// Modules: shared libraries that only some calls need, loaded on first use.

#include <string>

namespace gi {

/// A function of a module, which stays loaded.
/// @param module  file name, looked for where the program and its modules lie, then in the system's folders
/// @param name    of the function, as the module exports it
/// @param problem, remedy  of the InputError where the module or the function is missing; its reason is the loader's
void* module_function(char const* module, char const* name, std::string const& problem, std::string const& remedy);

} // namespace gi
