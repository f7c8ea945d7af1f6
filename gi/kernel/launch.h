#pragma once
// Runs a kernel over n items. A kernel is a trivially copyable struct with operator()(std::size_t i) const,
// written once in a header. The caller chooses the space that runs it; the kernel's views must lie in that space.

#include "gi/kernel/device.h"
#include "gi/kernel/device_work.h"

#include <cstddef>
#include <tbb/parallel_for.h>
#include <type_traits>

namespace gi {

/// Defined in launch.cuh; instantiated for each kernel in a .cu file of its own. Returns before the device is done:
/// launches and copies of all threads follow each other there. In debug builds it waits.
template <class Kernel>
void launch_device(char const* name, std::size_t n, Kernel const& kernel);

/// Not inlined: TBB would contain several copies, which compilers may round differently, and which copy runs an
/// item would be a matter of timing.
template <class Kernel>
[[gnu::noinline]] void run_items(Kernel const& kernel, std::size_t begin, std::size_t end)
{
    for (std::size_t i = begin; i != end; ++i) kernel(i);
}

template <class Kernel>
void launch_host(std::size_t n, Kernel const& kernel)
{
    static_assert(std::is_trivially_copyable_v<Kernel>);
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, n),
                      [&](auto const& range) { run_items(kernel, range.begin(), range.end()); });
}

/// @param name appears in counts and errors; what fails on a device while it runs is named so in debug builds alone, else by the next wait
template <class Kernel>
void launch(Space space, char const* name, std::size_t n, Kernel const& kernel)
{
    if (space == Space::device && n > 0) count_device::launches(name);
    if (space == Space::host || is_device_simulated())
        launch_host(n, kernel);
    else if constexpr (kCudaBuild)
        launch_device(name, n, kernel);
    else
        throw_no_cuda(name);
}

} // namespace gi
