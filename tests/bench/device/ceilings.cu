#include "tests/bench/device/ceilings.h"

#include "gi/kernel/launch.cuh"

namespace gi {

template void launch_device(char const*, std::size_t, bench::CopyWords const&);
template void launch_device(char const*, std::size_t, bench::ReadAnywhere const&);

} // namespace gi
