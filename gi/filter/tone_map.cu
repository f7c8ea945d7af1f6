#include "gi/filter/tone_map.h"

#include "gi/kernel/launch.cuh"

namespace gi {

template void launch_device(char const* name, std::size_t n, ToneMap const& kernel);

} // namespace gi
