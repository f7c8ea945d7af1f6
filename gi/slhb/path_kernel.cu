#include "gi/slhb/path_kernel.h"

#include "gi/base/launch.cuh"

namespace gi {

template void launch_device(char const*, std::size_t, TracePaths const&);

} // namespace gi
