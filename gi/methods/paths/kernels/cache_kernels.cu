#include "gi/methods/paths/kernels/cache_kernels.h"

#include "gi/kernel/launch.cuh"

namespace gi {

template void launch_device(char const*, std::size_t, CountExponents const&);
template void launch_device(char const*, std::size_t, LearnNotes const&);
template void launch_device(char const*, std::size_t, MoveCells const&);

} // namespace gi
