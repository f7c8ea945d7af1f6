#include "gi/methods/paths/shared_vertices.h"

#include "gi/core/rng.h"

#include <algorithm>
#include <atomic>
#include <tbb/parallel_for.h>

namespace gi {
namespace {

/// A pass-dependent permutation, so that the first path of a slot is a random one.
constexpr std::uint32_t kOdd = 0x9e3779b1;
constexpr std::uint32_t inverse_of(std::uint32_t odd)
{
    // Newton: each step doubles the number of correct bits, initially three for an odd number.
    std::uint32_t x = odd;
    for (int i = 0; i < 4; ++i) x *= 2 - odd * x;
    return x;
}
std::uint32_t rank_of(std::uint32_t path, std::uint32_t key) { return (path ^ key) * kOdd; }
std::uint32_t path_of(std::uint32_t rank, std::uint32_t key) { return (rank * inverse_of(kOdd)) ^ key; }

} // namespace

void SharedVertices::start(std::size_t paths, std::size_t layers, std::uint32_t pass)
{
    order_key_ = std::uint32_t(mix_bits(pass)) & 0x7fffffff; // so that no path gets the rank kNone
    slots_.assign(2 * layers, kNone);
    start_of_.resize(layers > 0 ? paths : 0);
    starts_.clear();
}

void SharedVertices::note(std::uint32_t path, SharedVertex const& e)
{
    if (e.triangle == kNoLayerHit) return note_none(path);
    std::size_t const at = 2 * std::size_t(e.layer) + (e.up ? 1 : 0);
    start_of_[path] = std::uint32_t(at);
    std::atomic_ref<std::uint32_t> const slot(slots_[at]);
    std::uint32_t const rank = rank_of(path, order_key_);
    for (std::uint32_t seen = slot.load(std::memory_order_relaxed);
         rank < seen && !slot.compare_exchange_weak(seen, rank, std::memory_order_relaxed);) {
    }
}

void SharedVertices::collect(std::vector<SharedVertex> const& shared_vertices)
{
    if (slots_.empty()) return;
    for (std::uint32_t& slot : slots_) {
        if (slot == kNone) continue;
        std::uint32_t const path = path_of(slot, order_key_);
        SharedVertex const& e = shared_vertices[path];
        starts_.push_back({0x80000000u | path, e.triangle, {e.position, e.arrival}, true});
        slot = std::uint32_t(starts_.size() - 1);
    }
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, start_of_.size(), 4096), [&](auto const& range) {
        for (std::size_t path = range.begin(); path != range.end(); ++path)
            if (has(path)) start_of_[path] = slots_[start_of_[path]];
    });
    radiance_.resize(starts_.size());
    shaded_ += starts_.size();
}

void SharedVertices::keep(std::size_t first, std::span<PathSample const> samples)
{
    for (std::size_t k = 0; k < samples.size(); ++k) radiance_[first + k] = samples[k].radiance[2];
}

} // namespace gi
