#pragma once
// Kernels whose items trace several paths one after the other.

#include <algorithm>
#include <cstddef>

namespace gi {

/// Number of items: enough to fill a device, few enough that each has several paths of a large picture.
inline std::size_t path_workers(std::size_t paths)
{
    constexpr std::size_t kMost = std::size_t(1) << 17;
    return std::min(paths, kMost);
}

} // namespace gi
