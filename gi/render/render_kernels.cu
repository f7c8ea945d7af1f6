#include "gi/render/add_samples.h"

#include "gi/kernel/launch.cuh"

namespace gi {

template void launch_device(char const*, std::size_t, AddSamples const&);

} // namespace gi
