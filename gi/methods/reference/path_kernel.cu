#include "gi/methods/reference/path_kernel.h"

#include "gi/kernel/launch.cuh"

namespace gi {

template void launch_device(char const*, std::size_t, StartPaths const&);
template void launch_device(char const*, std::size_t, ScatterPaths const&);
template void launch_device(char const*, std::size_t, FinishPaths<false> const&);
template void launch_device(char const*, std::size_t, FinishPaths<true> const&);
template void launch_device(char const*, std::size_t, EndPaths<AddToMeans> const&);
template void launch_device(char const*, std::size_t, EndPaths<KeepSamples> const&);

} // namespace gi
