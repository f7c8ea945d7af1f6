#include "gi/kernel/launch.cuh"
#include "gi/light_paths/bounce_map.h"
#include "gi/light_paths/trace_kernel.h"

namespace gi {

template void launch_device(char const*, std::size_t, TraceLightPaths const&);
template void launch_device(char const*, std::size_t, BounceTexels const&);

} // namespace gi
