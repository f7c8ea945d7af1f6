#pragma once
// What device.cu and scan.cu implement, and device.cpp and scan.cpp where there is no CUDA.

#include <cstddef>
#include <cstdint>

namespace gi::device {

void* allocate(std::size_t bytes);
void release(void* bytes) noexcept;
void fill(void* bytes, unsigned char value, std::size_t count);
/// Between the device and itself or the host; which is which is known from the addresses.
void copy(void* to, void const* from, std::size_t count);
/// In scan.cu and scan.cpp.
void exclusive_scan(std::uint32_t const* in, std::uint32_t* out, std::size_t n);

} // namespace gi::device
