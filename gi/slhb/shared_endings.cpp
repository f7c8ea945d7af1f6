#include "gi/slhb/shared_endings.h"

#include "gi/base/rng.h"

#include <algorithm>
#include <atomic>
#include <tbb/parallel_for.h>

namespace gi {
namespace {

/// Far more than there are cells, so that few have the same.
constexpr std::size_t kCellSlots = std::size_t(1) << 17;

/// A bijection, so that the first of a slot is any of its paths.
constexpr std::uint32_t kOdd = 0x9e3779b1;
constexpr std::uint32_t inverse_of(std::uint32_t odd)
{
    std::uint32_t x = odd; // Newton: each step doubles the right bits, of which odd has three
    for (int i = 0; i < 4; ++i) x *= 2 - odd * x;
    return x;
}
std::uint32_t rank_of(std::uint32_t path, std::uint32_t key) { return (path ^ key) * kOdd; }
std::uint32_t path_of(std::uint32_t rank, std::uint32_t key) { return (rank * inverse_of(kOdd)) ^ key; }

} // namespace

void SharedEndings::start(std::size_t paths, std::size_t slots, std::uint32_t pass)
{
    order_key_ = std::uint32_t(mix_bits(pass)) & 0x7fffffff; // no path has the rank kNone
    slots_.assign(slots, kNone);
    start_of_.resize(slots > 0 ? paths : 0);
    starts_.clear();
}

void SharedEndings::start_layers(std::size_t paths, std::size_t layers, std::uint32_t pass)
{
    cells_.reset();
    start(paths, 2 * layers, pass);
}

void SharedEndings::start_cells(std::size_t paths, EndingCells const& cells, std::uint32_t pass)
{
    cells_ = cells;
    keys_.resize(paths);
    start(paths, kCellSlots, pass);
}

void SharedEndings::note(std::uint32_t path, Ending const& e)
{
    if (e.triangle == kNoLayerHit) return note_none(path);
    std::size_t at = 0;
    if (cells_) {
        keys_[path] = cells_->key(e);
        at = keys_[path] % kCellSlots;
    } else {
        at = 2 * std::size_t(e.layer) + (e.up ? 1 : 0);
    }
    start_of_[path] = std::uint32_t(at);
    std::atomic_ref<std::uint32_t> const slot(slots_[at]);
    std::uint32_t const rank = rank_of(path, order_key_);
    for (std::uint32_t seen = slot.load(std::memory_order_relaxed);
         rank < seen && !slot.compare_exchange_weak(seen, rank, std::memory_order_relaxed);) {
    }
}

void SharedEndings::collect(std::vector<Ending> const& endings)
{
    if (slots_.empty()) return;
    auto const add = [&](std::uint32_t path) {
        Ending const& e = endings[path];
        starts_.push_back({0x80000000u | path, e.triangle, {e.position, e.arrival}, true});
        return std::uint32_t(starts_.size() - 1);
    };
    for (std::uint32_t& slot : slots_)
        if (slot != kNone) slot = add(path_of(slot, order_key_));
    constexpr std::size_t kBlock = 4096;
    std::vector<std::vector<std::uint32_t>> alone((start_of_.size() + kBlock - 1) / kBlock);
    tbb::parallel_for(std::size_t(0), alone.size(), [&](std::size_t block) {
        std::size_t const end = std::min(start_of_.size(), (block + 1) * kBlock);
        for (std::size_t path = block * kBlock; path < end; ++path) {
            if (!has(path)) continue;
            std::uint32_t const first = slots_[start_of_[path]];
            if (!cells_ || keys_[starts_[first].stream & 0x7fffffffu] == keys_[path])
                start_of_[path] = first;
            else
                alone[block].push_back(std::uint32_t(path));
        }
    });
    for (auto const& paths : alone)
        for (std::uint32_t const path : paths) start_of_[path] = add(path);
    radiance_.resize(starts_.size());
    shaded_ += starts_.size();
}

void SharedEndings::keep(std::size_t first, std::span<PathSample const> samples)
{
    for (std::size_t k = 0; k < samples.size(); ++k) radiance_[first + k] = samples[k].radiance[2];
}

} // namespace gi
