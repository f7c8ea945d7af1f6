#include "gi/kernel/buffer.h"
#include "gi/kernel/launch.cuh"

#include <cub/device/device_radix_sort.cuh>

namespace gi::device {

void sort_pairs(std::uint64_t* keys, std::uint32_t* values, std::uint64_t* scratch_keys,
                std::uint32_t* scratch_values, std::size_t n)
{
    if (n == 0) return;
    char const* const name = "sort";
    cub::DoubleBuffer<std::uint64_t> k(keys, scratch_keys);
    cub::DoubleBuffer<std::uint32_t> v(values, scratch_values);
    std::size_t bytes = 0;
    check_cuda(cub::DeviceRadixSort::SortPairs(nullptr, bytes, k, v, int(n)), name);
    Buffer<char, Space::device> scratch(bytes);
    check_cuda(cub::DeviceRadixSort::SortPairs(scratch.view().data, bytes, k, v, int(n)), name);
    if (k.Current() != keys) {
        check_cuda(cudaMemcpy(keys, k.Current(), n * sizeof(*keys), cudaMemcpyDeviceToDevice), name);
        check_cuda(cudaMemcpy(values, v.Current(), n * sizeof(*values), cudaMemcpyDeviceToDevice), name);
    }
}

} // namespace gi::device
