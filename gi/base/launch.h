#pragma once
// Running a kernel over n items. A kernel is a trivially copyable struct with operator()(std::size_t i) const,
// written once in a header; which space runs it is decided by the caller.

#include "gi/base/space.h"

#include <cstddef>
#include <tbb/parallel_for.h>
#include <type_traits>

namespace gi {

/// @param name appears in errors and timings
template <class Kernel>
void launch(Space space, char const* name, std::size_t n, Kernel const& kernel)
{
    static_assert(std::is_trivially_copyable_v<Kernel>);
    if (space != Space::host) throw_no_cuda(name);
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, n), [&](auto const& range) {
        for (std::size_t i = range.begin(); i != range.end(); ++i) kernel(i);
    });
}

} // namespace gi
