#include "gi/raster/raster_kernels.h"

#include "gi/kernel/launch.cuh"
#include "gi/raster/cut_outs.h"

namespace gi {

template void launch_device(char const*, std::size_t, CountShares<NearestRaster<RasterGrid>> const&);
template void launch_device(char const*, std::size_t, CountShares<NearestRaster<PerspectiveGrid>> const&);
template void launch_device(char const*, std::size_t, CountShares<LayerRaster> const&);
template void launch_device(char const*, std::size_t, CountLayers const&);
template void launch_device(char const*, std::size_t, StartLayers const&);
template void launch_device(char const*, std::size_t, FillLayers const&);
template void launch_device(char const*, std::size_t, DrawNearest<RasterGrid, KeepAll> const&);
template void launch_device(char const*, std::size_t, DrawNearest<PerspectiveGrid, KeepAll> const&);
template void launch_device(char const*, std::size_t, DrawNearest<RasterGrid, KeepUncut> const&);
template void launch_device(char const*, std::size_t, DrawNearest<PerspectiveGrid, KeepUncut> const&);
template void launch_device(char const*, std::size_t, UnpackNearest<RasterGrid> const&);
template void launch_device(char const*, std::size_t, UnpackNearest<PerspectiveGrid> const&);

} // namespace gi
