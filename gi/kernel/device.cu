#include "gi/kernel/device.h"

#include "gi/kernel/device_memory.h"
#include "gi/kernel/launch.cuh"

namespace gi {

bool device_present()
{
    int count = 0;
    return cudaGetDeviceCount(&count) == cudaSuccess && count > 0;
}

namespace device {

void* allocate(std::size_t bytes)
{
    void* pointer = nullptr;
    check_cuda(cudaMalloc(&pointer, bytes), "allocate device memory");
    return pointer;
}

void release(void* bytes) noexcept { cudaFree(bytes); }

void fill(void* bytes, unsigned char value, std::size_t count)
{
    check_cuda(cudaMemset(bytes, value, count), "fill device memory");
}

void copy(void* to, void const* from, std::size_t count)
{
    check_cuda(cudaMemcpy(to, from, count, cudaMemcpyDefault), "copy device memory");
}

} // namespace device
} // namespace gi
