#include "gi/core/module.h"

#include "gi/core/error.h"

#include <dlfcn.h>

namespace gi {

void* module_function(char const* module, char const* name, std::string const& problem, std::string const& remedy)
{
    void* const library = dlopen(module, RTLD_NOW | RTLD_LOCAL);
    void* const function = library != nullptr ? dlsym(library, name) : nullptr;
    if (function != nullptr) return function;
    char const* const why = dlerror();
    throw InputError(problem, why != nullptr ? why : std::string(module) + " is another version", remedy);
}

} // namespace gi
