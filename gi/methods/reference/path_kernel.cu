#include "gi/methods/reference/path_kernel.h"

#include "gi/kernel/launch.cuh"

namespace gi {

template void launch_device(char const*, std::size_t, StartPaths const&);
template void launch_device(char const*, std::size_t, ScatterPaths<AddToMeans> const&);
template void launch_device(char const*, std::size_t, ScatterPaths<KeepSamples> const&);
template void launch_device(char const*, std::size_t, FinishPaths<AddToMeans, false> const&);
template void launch_device(char const*, std::size_t, FinishPaths<AddToMeans, true> const&);
template void launch_device(char const*, std::size_t, FinishPaths<KeepSamples, false> const&);
template void launch_device(char const*, std::size_t, FinishPaths<KeepSamples, true> const&);

} // namespace gi
