#include "gi/kernel/device.h"

#include "gi/core/error.h"
#include "gi/core/huge_pages.h"
#include "gi/kernel/device_memory.h"
#include "gi/kernel/device_work.h"

#include <cstdlib>
#include <cstring>
#include <new>
#include <string_view>
#include <unistd.h>

namespace gi {
namespace {

/// Whether the processor reads and writes the memory of a space.
bool is_host(Space space) { return space == Space::host || is_device_simulated(); }

} // namespace

#if !defined(LIGHTWELL_CUDA_BUILD)
namespace device {
bool present() { return false; }
std::size_t memory() { throw_no_cuda("device memory"); }
void* allocate(std::size_t) { throw_no_cuda("device memory"); }
void release(void*) noexcept {}
void fill(void*, unsigned char, std::size_t) { throw_no_cuda("device memory"); }
void copy(void*, void const*, std::size_t) { throw_no_cuda("device memory"); }
void finish() { throw_no_cuda("device"); }
} // namespace device
#endif

bool is_device_simulated()
{
    static bool const simulated = [] {
        char const* const asked = std::getenv("LIGHTWELL_DEVICE");
        return asked != nullptr && std::string_view(asked) == "simulated";
    }();
    return simulated;
}

bool device_present() { return is_device_simulated() || device::present(); }

void check_device(Space space)
{
    if (space == Space::host || is_device_simulated()) return;
    if (char const* const asked = std::getenv("LIGHTWELL_DEVICE"); asked != nullptr && *asked != '\0')
        throw InputError("LIGHTWELL_DEVICE=" + std::string(asked) + " in the environment",
                         "it can only be simulated", "correct it, or unset it");
    if (!kCudaBuild)
        throw InputError("the device cuda cannot be used", "this program was built without CUDA",
                         "build the cuda preset, or choose the device cpu");
    if (!device_present())
        throw InputError("the device cuda cannot be used", "no CUDA device is present",
                         "run on a machine with one and its driver, or choose the device cpu");
}

std::size_t memory_bytes(Space space)
{
    if (!is_host(space)) return device::memory();
    return std::size_t(sysconf(_SC_PHYS_PAGES)) * std::size_t(sysconf(_SC_PAGE_SIZE));
}

void* allocate_bytes(Space space, std::size_t bytes)
{
    if (!is_host(space)) return device::allocate(bytes);
    constexpr std::size_t kLine = 64;
    void* const start = std::aligned_alloc(kLine, (bytes + kLine - 1) / kLine * kLine);
    if (start == nullptr) throw std::bad_alloc();
    advise_huge_pages(start, bytes);
    if (space == Space::device) std::memset(start, 0xFF, bytes);
    return start;
}

void free_bytes(Space space, void* bytes) noexcept
{
    if (is_host(space))
        std::free(bytes);
    else
        device::release(bytes);
}

void fill_bytes(Space space, void* bytes, unsigned char value, std::size_t count)
{
    if (count == 0) return;
    if (space == Space::device) count_device::fill();
    if (is_host(space))
        std::memset(bytes, value, count);
    else
        device::fill(bytes, value, count);
}

void copy_bytes(Space to_space, void* to, Space from_space, void const* from, std::size_t count)
{
    if (count == 0) return;
    if (to_space == Space::device && from_space == Space::device)
        count_device::copy_within(count);
    else if (to_space == Space::device)
        count_device::upload(count);
    else if (from_space == Space::device)
        count_device::download(count);
    if (is_host(to_space) && is_host(from_space))
        std::memcpy(to, from, count);
    else
        device::copy(to, from, count);
}

void finish(Space space)
{
    if (space == Space::host) return;
    count_device::wait();
    if (!is_device_simulated()) device::finish();
}

} // namespace gi
