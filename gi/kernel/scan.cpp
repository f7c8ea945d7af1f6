#include "gi/kernel/scan.h"

#include "gi/kernel/device.h"
#include "gi/kernel/device_memory.h"
#include "gi/kernel/device_work.h"

#include <numeric>
#include <stdexcept>

namespace gi {

namespace {
constexpr std::uint64_t kScanLaunches = 2; // of CUB: states of tiles, then the scan
} // namespace

#if !defined(LIGHTWELL_CUDA_BUILD)
namespace device {
void exclusive_scan(std::uint32_t const*, std::uint32_t*, std::size_t) { throw_no_cuda("exclusive scan"); }
} // namespace device
#endif

void exclusive_scan(Space space, View<std::uint32_t const> in, View<std::uint32_t> out)
{
    if (in.size() != out.size()) throw std::logic_error("input and output of a scan differ in length");
    if (space == Space::device && in.size() > 0) count_device::launches("exclusive scan", kScanLaunches);
    if (space == Space::host || is_device_simulated())
        std::exclusive_scan(in.begin(), in.end(), out.begin(), 0u);
    else
        device::exclusive_scan(in.data, out.data, in.size());
}

} // namespace gi
