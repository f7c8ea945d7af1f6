#include "gi/kernel/space.h"

#include <stdexcept>
#include <string>

namespace gi {

void throw_no_cuda(char const* what)
{
    throw std::runtime_error(std::string(what) + ": built without CUDA (configure with the cuda preset)");
}

} // namespace gi
