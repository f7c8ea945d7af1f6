#include "gi/scene/motion/deform_kernels.h"

#include "gi/kernel/launch.cuh"

namespace gi {

template void launch_device(char const*, std::size_t, DeformVertices<RigidPlacement> const&);
template void launch_device(char const*, std::size_t, DeformVertices<LinearPlacement> const&);
template void launch_device(char const*, std::size_t, DeformVertices<DualQuaternionPlacement> const&);

} // namespace gi
