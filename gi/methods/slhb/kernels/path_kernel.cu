#include "gi/methods/slhb/kernels/path_kernel.h"

#include "gi/kernel/launch.cuh"

namespace gi {

template void launch_device(char const*, std::size_t, FirstSteps<false> const&);
template void launch_device(char const*, std::size_t, FirstSteps<true> const&);
template void launch_device(char const*, std::size_t, FurtherSteps<false, false> const&);
template void launch_device(char const*, std::size_t, FurtherSteps<false, true> const&);
template void launch_device(char const*, std::size_t, FurtherSteps<true, false> const&);
template void launch_device(char const*, std::size_t, FurtherSteps<true, true> const&);
template void launch_device(char const*, std::size_t, AddDoubtfulLight const&);

} // namespace gi
