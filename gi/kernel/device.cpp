#include "gi/kernel/device.h"

#include "gi/core/error.h"
#include "gi/core/huge_pages.h"
#include "gi/kernel/device_memory.h"

#include <cstdlib>
#include <cstring>
#include <new>

namespace gi {

#if !defined(LIGHTWELL_CUDA_BUILD)
bool device_present() { return false; }
namespace device {
void* allocate(std::size_t) { throw_no_cuda("device memory"); }
void release(void*) noexcept {}
void fill(void*, unsigned char, std::size_t) { throw_no_cuda("device memory"); }
void copy(void*, void const*, std::size_t) { throw_no_cuda("device memory"); }
} // namespace device
#endif

void check_device(Space space)
{
    if (space == Space::host) return;
    if (!kCudaBuild)
        throw InputError("the device cuda cannot be used", "this program was built without CUDA",
                         "build the cuda preset, or choose the device cpu");
    if (!device_present())
        throw InputError("the device cuda cannot be used", "no CUDA device is present",
                         "run on a machine with one and its driver, or choose the device cpu");
}

void* allocate_bytes(Space space, std::size_t bytes)
{
    if (space == Space::device) return device::allocate(bytes);
    constexpr std::size_t kLine = 64;
    void* const start = std::aligned_alloc(kLine, (bytes + kLine - 1) / kLine * kLine);
    if (start == nullptr) throw std::bad_alloc();
    advise_huge_pages(start, bytes);
    return start;
}

void free_bytes(Space space, void* bytes) noexcept
{
    if (space == Space::host)
        std::free(bytes);
    else
        device::release(bytes);
}

void fill_bytes(Space space, void* bytes, unsigned char value, std::size_t count)
{
    if (count == 0) return;
    if (space == Space::host)
        std::memset(bytes, value, count);
    else
        device::fill(bytes, value, count);
}

void copy_bytes(Space to_space, void* to, Space from_space, void const* from, std::size_t count)
{
    if (count == 0) return;
    if (to_space == Space::host && from_space == Space::host)
        std::memcpy(to, from, count);
    else
        device::copy(to, from, count);
}

} // namespace gi
