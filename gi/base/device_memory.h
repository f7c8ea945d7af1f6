#pragma once
// What device.cu implements, and device.cpp where there is no CUDA.

#include <cstddef>

namespace gi::device {

void* allocate(std::size_t bytes);
void release(void* bytes) noexcept;
void fill(void* bytes, unsigned char value, std::size_t count);
/// Between the device and itself or the host; which is which is known from the addresses.
void copy(void* to, void const* from, std::size_t count);

} // namespace gi::device
