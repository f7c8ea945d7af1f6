#include "gi/raster/fragments.h"

#include <algorithm>
#include <mutex>
#include <utility>
#include <vector>

namespace gi {
namespace {

struct Spares {
    std::mutex mutex;
    std::vector<Fragments> fragments; ///< those returned last at the end
    std::size_t borrowed = 0;
    unsigned releases = 0;
};

/// Never destroyed: threads may outlive static objects.
Spares& spares()
{
    static Spares& all = *new Spares;
    return all;
}

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

BorrowedFragments::BorrowedFragments()
{
    Spares& s = spares();
    std::lock_guard const lock(s.mutex);
    s.fragments.reserve(s.fragments.size() + s.borrowed + 1); // for all that will be returned
    ++s.borrowed;
    since_ = s.releases;
    if (s.fragments.empty()) return;
    fragments_ = std::move(s.fragments.back());
    s.fragments.pop_back();
    fragments_.count = 0;
}

BorrowedFragments::~BorrowedFragments()
{
    Spares& s = spares();
    std::lock_guard const lock(s.mutex);
    --s.borrowed;
    if (since_ == s.releases) s.fragments.push_back(std::move(fragments_));
}

void release_spare_fragments()
{
    Spares& s = spares();
    std::vector<Fragments> freed;
    std::lock_guard const lock(s.mutex);
    ++s.releases;
    freed.swap(s.fragments);
}

} // namespace gi
