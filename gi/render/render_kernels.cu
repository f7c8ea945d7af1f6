#include "gi/render/add_samples.h"

#include "gi/kernel/launch.cuh"
#include "gi/render/ray_kernels.h"

namespace gi {

template void launch_device(char const*, std::size_t, AddSamples const&);
template void launch_device(char const*, std::size_t, RaysOfPaths<false> const&);
template void launch_device(char const*, std::size_t, RaysOfPaths<true> const&);

} // namespace gi
