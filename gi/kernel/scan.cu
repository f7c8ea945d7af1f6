#include "gi/kernel/buffer.h"
#include "gi/kernel/launch.cuh"

#include <cub/device/device_scan.cuh>

namespace gi::device {

void exclusive_scan(std::uint32_t const* in, std::uint32_t* out, std::size_t n)
{
    if (n == 0) return;
    char const* const name = "exclusive scan";
    std::size_t bytes = 0;
    check_cuda(cub::DeviceScan::ExclusiveSum(nullptr, bytes, in, out, n), name);
    Buffer<char, Space::device> scratch(bytes);
    check_cuda(cub::DeviceScan::ExclusiveSum(scratch.view().data, bytes, in, out, n), name);
}

} // namespace gi::device
