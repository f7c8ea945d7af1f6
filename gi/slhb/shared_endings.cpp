#include "gi/slhb/shared_endings.h"

#include <algorithm>
#include <atomic>

namespace gi {

void SharedEndings::start(std::size_t layers)
{
    slots_.assign(2 * layers, kNoLayerHit);
    starts_.clear();
}

void SharedEndings::note(std::span<Ending const> endings, std::uint32_t first_pixel)
{
    for (std::size_t k = 0; k < endings.size(); ++k) {
        if (endings[k].layer == kNoLayerHit) continue;
        std::atomic_ref<std::uint32_t> const slot(slots_[key(endings[k])]);
        std::uint32_t const pixel = first_pixel + std::uint32_t(k);
        for (std::uint32_t seen = slot.load(std::memory_order_relaxed);
             pixel < seen && !slot.compare_exchange_weak(seen, pixel, std::memory_order_relaxed);) {
        }
    }
}

void SharedEndings::collect(std::vector<Ending> const& endings, AxisPool const& pool)
{
    for (std::size_t k = 0; k < slots_.size(); ++k) {
        if (slots_[k] == kNoLayerHit) continue;
        Ending const& e = endings[slots_[k]];
        vec3 const along = pool.grids[e.axis].axis;
        slots_[k] = std::uint32_t(starts_.size());
        starts_.push_back({0x80000000u | std::uint32_t(k), e.triangle, {e.position, e.up ? along : -along}, true});
    }
    radiance_.resize(starts_.size());
    shaded_ += starts_.size();
}

void SharedEndings::keep(std::size_t first, std::span<PathSample const> samples)
{
    for (std::size_t k = 0; k < samples.size(); ++k) radiance_[first + k] = samples[k].radiance[2];
}

} // namespace gi
