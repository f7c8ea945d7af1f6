#pragma once
// Device part of launch(). A kernel's .cu file includes this file and the kernel's header, and instantiates
// launch_device for the kernel.

#include "gi/kernel/launch.h"

#include <cuda_runtime.h>
#include <stdexcept>
#include <string>

namespace gi {

/// On a CUDA error, throws std::runtime_error with `what` and CUDA's error message.
inline void check_cuda(cudaError_t error, char const* what)
{
    if (error == cudaSuccess) return;
    cudaGetLastError(); // is no error of the next launch
    throw std::runtime_error(std::string(what) + ": CUDA: " + cudaGetErrorString(error));
}

template <class Kernel>
__global__ void run_kernel(std::size_t n, Kernel kernel)
{
    std::size_t const stride = std::size_t(gridDim.x) * blockDim.x;
    for (std::size_t i = std::size_t(blockIdx.x) * blockDim.x + threadIdx.x; i < n; i += stride) kernel(i);
}

template <class Kernel>
void launch_device(char const* name, std::size_t n, Kernel const& kernel)
{
    if (n == 0) return;
    constexpr std::size_t kBlock = 128, kMostBlocks = std::size_t(1) << 20;
    std::size_t const blocks = (n + kBlock - 1) / kBlock;
    run_kernel<<<unsigned(blocks < kMostBlocks ? blocks : kMostBlocks), unsigned(kBlock)>>>(n, kernel);
    check_cuda(cudaGetLastError(), name);
#ifndef NDEBUG
    check_cuda(cudaDeviceSynchronize(), name); // so that a failure names its kernel
#endif
}

} // namespace gi
