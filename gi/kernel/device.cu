#include "gi/kernel/device.h"

#include "gi/kernel/device_memory.h"
#include "gi/kernel/launch.cuh"

#include <new>

namespace gi {

namespace device {
namespace {

/// Whether freed memory is kept for later buffers: a frame allocates hundreds, and without a pool each waits for
/// the driver. What exceeds kKept goes back at the next wait.
bool has_pool()
{
    static bool const pool = [] {
        constexpr std::uint64_t kKept = std::uint64_t(1) << 30; // bytes
        std::uint64_t kept = kKept;
        int device = 0, supported = 0;
        cudaMemPool_t of_device = nullptr;
        bool const has =
            cudaGetDevice(&device) == cudaSuccess &&
            cudaDeviceGetAttribute(&supported, cudaDevAttrMemoryPoolsSupported, device) == cudaSuccess &&
            supported != 0 && cudaDeviceGetDefaultMemPool(&of_device, device) == cudaSuccess &&
            cudaMemPoolSetAttribute(of_device, cudaMemPoolAttrReleaseThreshold, &kept) == cudaSuccess;
        cudaGetLastError(); // a refusal is no error of the next launch
        return has;
    }();
    return pool;
}

} // namespace

bool present()
{
    int count = 0;
    return cudaGetDeviceCount(&count) == cudaSuccess && count > 0;
}

std::size_t memory()
{
    std::size_t free = 0, all = 0;
    check_cuda(cudaMemGetInfo(&free, &all), "size of device memory");
    return all;
}

void* allocate(std::size_t bytes)
{
    void* pointer = nullptr;
    cudaError_t const error = has_pool() ? cudaMallocAsync(&pointer, bytes, nullptr) : cudaMalloc(&pointer, bytes);
    if (error == cudaErrorMemoryAllocation) {
        cudaGetLastError(); // is no error of the next launch
        throw std::bad_alloc();
    }
    check_cuda(error, "allocate device memory");
    return pointer;
}

void release(void* bytes) noexcept
{
    if (has_pool())
        cudaFreeAsync(bytes, nullptr);
    else
        cudaFree(bytes);
}

void fill(void* bytes, unsigned char value, std::size_t count)
{
    check_cuda(cudaMemset(bytes, value, count), "fill device memory");
}

void copy(void* to, void const* from, std::size_t count)
{
    check_cuda(cudaMemcpy(to, from, count, cudaMemcpyDefault), "copy device memory");
}

void finish() { check_cuda(cudaDeviceSynchronize(), "wait for the device"); }

} // namespace device
} // namespace gi
