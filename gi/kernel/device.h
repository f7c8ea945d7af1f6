#pragma once
// Memory of the host and of the CUDA device. A build without CUDA has no device: everything that names it throws
// std::runtime_error and device_present() is false.

#include "gi/kernel/space.h"

#include <cstddef>

namespace gi {

/// Whether this build and this machine can run kernels on a device.
bool device_present();
/// Throws InputError where that is not so and `space` is the device.
void check_device(Space space);

/// Uninitialised bytes; throws std::bad_alloc (host) or std::runtime_error naming the CUDA error (device).
void* allocate_bytes(Space space, std::size_t bytes);
void free_bytes(Space space, void* bytes) noexcept;
void fill_bytes(Space space, void* bytes, unsigned char value, std::size_t count);
void copy_bytes(Space to_space, void* to, Space from_space, void const* from, std::size_t count);

} // namespace gi
