#pragma once
// Memory of the host and of the CUDA device. In a build without CUDA, every use of the device throws
// std::runtime_error and device_present() is false, unless the device is simulated.

#include "gi/kernel/space.h"

#include <cstddef>

namespace gi {

/// True if this build and this machine can run kernels on a CUDA device, or if the device is simulated.
bool device_present();
/// True if LIGHTWELL_DEVICE=simulated in the environment: the processor runs the kernels that would run on the device, and
/// memory of the device is memory of the host, at first filled with 0xFF bytes. So machines without a device
/// test all that programs do around kernels.
bool is_device_simulated();
/// Throws InputError if `space` is the device and no device is present.
void check_device(Space space);

/// That a space has in all.
std::size_t memory_bytes(Space space);
/// Returns uninitialised bytes; throws std::bad_alloc, or std::runtime_error naming the CUDA error.
void* allocate_bytes(Space space, std::size_t bytes);
void free_bytes(Space space, void* bytes) noexcept;
void fill_bytes(Space space, void* bytes, unsigned char value, std::size_t count);
void copy_bytes(Space to_space, void* to, Space from_space, void const* from, std::size_t count);
/// Waits until a space has done all that it was given, and throws std::runtime_error if something failed. Launches
/// on a device return at once; copies to the host wait by themselves.
void finish(Space space);

} // namespace gi
