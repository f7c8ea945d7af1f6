#include "gi/kernel/launch.cuh"
#include "gi/methods/sh_grid/field_kernels.h"
#include "gi/methods/sh_grid/photon_kernels.h"
#include "gi/methods/sh_grid/radiance_kernels.h"

namespace gi {

template void launch_device(char const*, std::size_t, FindPhotonPatches const&);
template void launch_device(char const*, std::size_t, FindFirstPhotons const&);
template void launch_device(char const*, std::size_t, SumPhotons const&);
template void launch_device(char const*, std::size_t, WalkVoxels const&);
template void launch_device(char const*, std::size_t, ProjectLight const&);

} // namespace gi
