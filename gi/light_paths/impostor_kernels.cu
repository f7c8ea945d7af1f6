#include "gi/kernel/launch.cuh"
#include "gi/light_paths/impostor_kernels.h"
#include "gi/light_paths/impostor_walk.h"

namespace gi {

template void launch_device(char const*, std::size_t, StoreImpostorFace const&);
template void launch_device(char const*, std::size_t, BoundImpostorBlocks const&);
template void launch_device(char const*, std::size_t, FollowByImpostors const&);

} // namespace gi
