#include "gi/hit_buffers/layer_kernels.h"

#include "gi/kernel/launch.cuh"
#include "gi/raster/cut_outs.h"
#include "gi/raster/raster_kernels.h"

namespace gi {

template void launch_device(char const*, std::size_t, SortLayers const&);
template void launch_device(char const*, std::size_t, TrimLayers<KeepAll> const&);
template void launch_device(char const*, std::size_t, TrimLayers<KeepUncut> const&);
template void launch_device(char const*, std::size_t, PackLayers const&);
template void launch_device(char const*, std::size_t, AnswerQueries const&);

} // namespace gi
