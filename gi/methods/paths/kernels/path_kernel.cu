#include "gi/methods/paths/kernels/path_kernel.h"

#include "gi/kernel/launch.cuh"

namespace gi {

template void launch_device(char const*, std::size_t, StartRays const&);
template void launch_device(char const*, std::size_t, FirstSteps<FindBy::look_ups> const&);
template void launch_device(char const*, std::size_t, FurtherSteps<FindBy::look_ups, false> const&);
template void launch_device(char const*, std::size_t, FurtherSteps<FindBy::look_ups, true> const&);
template void launch_device(char const*, std::size_t, FirstSteps<FindBy::look_ups_and_rays> const&);
template void launch_device(char const*, std::size_t, FurtherSteps<FindBy::look_ups_and_rays, false> const&);
template void launch_device(char const*, std::size_t, FurtherSteps<FindBy::look_ups_and_rays, true> const&);
template void launch_device(char const*, std::size_t, FirstSteps<FindBy::rays> const&);
template void launch_device(char const*, std::size_t, FurtherSteps<FindBy::rays, false> const&);
template void launch_device(char const*, std::size_t, FurtherSteps<FindBy::rays, true> const&);
template void launch_device(char const*, std::size_t, RaysOfSteps<false> const&);
template void launch_device(char const*, std::size_t, RaysOfSteps<true> const&);

} // namespace gi
