#include "gi/kernel/launch.cuh"
#include "gi/methods/photons/splat_kernels.h"

namespace gi {

template void launch_device(char const*, std::size_t, CountTiles const&);
template void launch_device(char const*, std::size_t, FillTiles const&);
template void launch_device(char const*, std::size_t, SortTiles const&);
template void launch_device(char const*, std::size_t, SplatPixels const&);

} // namespace gi
