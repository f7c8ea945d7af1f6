#include "gi/kernel/scan.h"

#include "gi/kernel/device_memory.h"

#include <numeric>
#include <stdexcept>

namespace gi {

#if !defined(LIGHTWELL_CUDA_BUILD)
namespace device {
void exclusive_scan(std::uint32_t const*, std::uint32_t*, std::size_t) { throw_no_cuda("exclusive scan"); }
} // namespace device
#endif

void exclusive_scan(Space space, View<std::uint32_t const> in, View<std::uint32_t> out)
{
    if (in.size() != out.size()) throw std::logic_error("input and output of a scan differ in length");
    if (space == Space::host)
        std::exclusive_scan(in.begin(), in.end(), out.begin(), 0u);
    else
        device::exclusive_scan(in.data, out.data, in.size());
}

} // namespace gi
