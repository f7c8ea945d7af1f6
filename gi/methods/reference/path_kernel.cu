#include "gi/methods/reference/path_kernel.h"

#include "gi/kernel/launch.cuh"

namespace gi {

template void launch_device(char const*, std::size_t, TraceReference<AddToMeans> const&);
template void launch_device(char const*, std::size_t, TraceReference<KeepSamples> const&);

} // namespace gi
