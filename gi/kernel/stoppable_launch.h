#pragma once
// Kernels on the host that end early when a stop is requested, for those that may take longer than a person waits.

#include "gi/core/progress.h"
#include "gi/kernel/launch.h"

#include <algorithm>

namespace gi {

/// As launch_host(). Throws Interrupted; what the kernel writes is then incomplete.
template <class Kernel>
void launch_host(std::size_t n, Kernel const& kernel, BuildStop const& stop)
{
    static_assert(std::is_trivially_copyable_v<Kernel>);
    constexpr std::size_t kTogether = 256;
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, n), [&](auto const& range) {
        for (std::size_t begin = range.begin(); begin < range.end(); begin += kTogether) {
            if (stop.given_up()) throw Interrupted();
            run_items(kernel, begin, std::min(begin + kTogether, range.end()));
        }
    });
}

} // namespace gi
