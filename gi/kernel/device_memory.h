#pragma once
// Device functions implemented by device.cu and scan.cu, or by device.cpp and scan.cpp in builds without CUDA.

#include <cstddef>
#include <cstdint>

namespace gi::device {

bool present();
std::size_t memory();              ///< bytes, of the device in all
void* allocate(std::size_t bytes); ///< throws std::bad_alloc
void release(void* bytes) noexcept;
void fill(void* bytes, unsigned char value, std::size_t count);
/// Copies within the device or between device and host; the addresses determine the direction.
void copy(void* to, void const* from, std::size_t count);
void finish();
/// Implemented in scan.cu and scan.cpp.
void exclusive_scan(std::uint32_t const* in, std::uint32_t* out, std::size_t n);

} // namespace gi::device
