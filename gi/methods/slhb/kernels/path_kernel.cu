#include "gi/methods/slhb/kernels/path_kernel.h"

#include "gi/kernel/launch.cuh"

namespace gi {

template void launch_device(char const*, std::size_t, TracePaths<false> const&);
template void launch_device(char const*, std::size_t, TracePaths<true> const&);

} // namespace gi
