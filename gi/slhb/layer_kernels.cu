#include "gi/slhb/layer_kernels.h"

#include "gi/base/launch.cuh"
#include "gi/raster/raster_kernels.h"

namespace gi {

template void launch_device(char const*, std::size_t, SortLayers const&);
template void launch_device(char const*, std::size_t, TrimLayers<KeepAll> const&);
template void launch_device(char const*, std::size_t, PackLayers const&);
template void launch_device(char const*, std::size_t, AnswerQueries const&);

} // namespace gi
