#include "gi/raster/fragments.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <utility>

namespace gi {
namespace {

std::atomic<unsigned> releases = 0;

/// Of one thread, which may borrow more of them while it waits for others.
struct Spare {
    std::array<Fragments, 2> fragments;
    unsigned since = 0;
};
thread_local Spare spare;

} // namespace

void Fragments::grow(std::size_t needed)
{
    capacity = std::max({needed, 2 * capacity, std::size_t(4096)});
    auto const move = [&](auto& array) {
        using T = std::remove_reference_t<decltype(array[0])>;
        std::unique_ptr<T[]> larger(new T[capacity]);
        std::copy_n(array.get(), count, larger.get());
        array = std::move(larger);
    };
    move(texel);
    move(depth);
    move(primitive);
}

BorrowedFragments::BorrowedFragments() : since_(releases)
{
    if (spare.since != since_) spare = {{}, since_};
    auto const largest = std::ranges::max_element(spare.fragments, {}, &Fragments::capacity);
    fragments_ = std::exchange(*largest, {});
    fragments_.count = 0;
}

BorrowedFragments::~BorrowedFragments()
{
    if (spare.since != since_) return;
    auto const smallest = std::ranges::min_element(spare.fragments, {}, &Fragments::capacity);
    if (smallest->capacity < fragments_.capacity) *smallest = std::move(fragments_);
}

void release_spare_fragments() { ++releases; }

} // namespace gi
