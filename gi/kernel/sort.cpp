#include "gi/kernel/sort.h"

#include "gi/kernel/device.h"
#include "gi/kernel/device_work.h"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#include <vector>

namespace gi {

#if !defined(LIGHTWELL_CUDA_BUILD)
namespace device {
void sort_pairs(std::uint64_t*, std::uint32_t*, std::uint64_t*, std::uint32_t*, std::size_t)
{
    throw_no_cuda("sort");
}
} // namespace device
#else
namespace device {
void sort_pairs(std::uint64_t* keys, std::uint32_t* values, std::uint64_t* scratch_keys,
                std::uint32_t* scratch_values, std::size_t n);
} // namespace device
#endif

namespace {

constexpr int kDigitBits = 11, kDigits = (64 + kDigitBits - 1) / kDigitBits;
constexpr std::size_t kBuckets = std::size_t(1) << kDigitBits;
constexpr std::uint64_t kSortLaunches = 10; // of CUB for 64 bits: histogram, scan, 8 passes
using Histogram = std::array<std::uint32_t, kBuckets>;

/// One pass of a radix sort: counts per block, then moves in order.
void sort_digit(View<std::uint64_t const> keys, View<std::uint32_t const> values, View<std::uint64_t> to_keys,
                View<std::uint32_t> to_values, int shift, std::vector<Histogram>& counts)
{
    std::size_t const n = keys.size(), blocks = counts.size();
    auto const first = [&](std::size_t b) { return n * b / blocks; };
    auto const digit = [&](std::size_t i) { return std::size_t(keys[i] >> shift) & (kBuckets - 1); };
    tbb::parallel_for(std::size_t(0), blocks, [&](std::size_t b) {
        counts[b].fill(0);
        for (std::size_t i = first(b); i < first(b + 1); ++i) ++counts[b][digit(i)];
    });
    std::uint32_t sum = 0;
    for (std::size_t d = 0; d < kBuckets; ++d)
        for (Histogram& of_block : counts) sum += std::exchange(of_block[d], sum);
    tbb::parallel_for(std::size_t(0), blocks, [&](std::size_t b) {
        for (std::size_t i = first(b); i < first(b + 1); ++i) {
            std::uint32_t const to = counts[b][digit(i)]++;
            to_keys[to] = keys[i];
            to_values[to] = values[i];
        }
    });
}

} // namespace

void sort_pairs(Space space, View<std::uint64_t> keys, View<std::uint32_t> values,
                View<std::uint64_t> scratch_keys, View<std::uint32_t> scratch_values)
{
    std::size_t const n = keys.size();
    if (values.size() != n || scratch_keys.size() != n || scratch_values.size() != n)
        throw std::logic_error("keys, values and scratch memory of a sort differ in length");
    if (space == Space::device && n > 0) count_device::launches("sort", kSortLaunches);
    if (space == Space::device && !is_device_simulated())
        return device::sort_pairs(keys.data, values.data, scratch_keys.data, scratch_values.data, n);
    std::vector<Histogram> counts(std::size_t(std::max(1, tbb::this_task_arena::max_concurrency())));
    static_assert(kDigits % 2 == 0); // so that the result ends where it began
    for (int d = 0; d < kDigits; ++d) {
        View<std::uint64_t const> const from_keys{keys.data, n};
        View<std::uint32_t const> const from_values{values.data, n};
        sort_digit(from_keys, from_values, scratch_keys, scratch_values, d * kDigitBits, counts);
        std::swap(keys, scratch_keys);
        std::swap(values, scratch_values);
    }
}

} // namespace gi
