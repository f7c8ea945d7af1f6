#include "gi/render/pair_sums.h"

#include <tbb/parallel_for.h>

namespace gi {
namespace {

constexpr std::uint32_t kNone = 0xffffffff;
constexpr std::size_t kGrain = 4096; // pixels

template <class F>
void in_parallel(std::size_t n, F const& work)
{
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, n, kGrain), [&](auto const& range) {
        for (std::size_t i = range.begin(); i != range.end(); ++i) work(i);
    });
}

} // namespace

void PairSums::start(int width, int height)
{
    if (first_.width != width || first_.height != height) first_ = Accumulator(width, height);
    first_.paths = 0;
    slot_.assign(first_.pixels.size(), kNone);
    pixels_.clear();
    second_.clear();
}

void PairSums::add(std::span<PathSample const> first, std::span<std::uint32_t const> pixels,
                   std::span<PathSample const> second)
{
    other_.assign(pixels_.size(), kNone);
    for (std::uint32_t k = 0; k < pixels.size(); ++k) {
        std::uint32_t const p = pixels[k];
        if (slot_[p] == kNone) { // equal until now
            slot_[p] = std::uint32_t(pixels_.size());
            pixels_.push_back(p);
            other_.push_back(kNone);
            second_.push_back(first_.paths > 0 ? first_.pixels[p] : PixelMeans{});
        }
        other_[slot_[p]] = k;
    }
    in_parallel(first.size(), [&](std::size_t p) { first_.add(p, first[p], first_.paths); });
    in_parallel(second_.size(), [&](std::size_t s) {
        second_[s].add(other_[s] == kNone ? first[pixels_[s]] : second[other_[s]], first_.paths + 1);
    });
    ++first_.paths;
}

void PairSums::make_second(World const& world, Picture& picture) const
{
    first_.put(world, pixels_, second_, picture);
}

} // namespace gi
