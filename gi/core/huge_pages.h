#pragma once
// Large arrays that are read at random miss the TLB more often than the cache unless their pages are large.

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace gi {

/// Asks the system to back these bytes with large pages as they are first touched; no more than a hint.
void advise_huge_pages(void* first, std::size_t bytes);

/// v.resize(count), on large pages where it needs new memory.
template <class T, class Allocator>
void resize_on_huge_pages(std::vector<T, Allocator>& v, std::size_t count)
{
    if (count > v.capacity()) {
        std::vector<T, Allocator> grown;
        grown.reserve(std::max(count, 2 * v.size()));
        advise_huge_pages(grown.data(), grown.capacity() * sizeof(T)); // before the pages are touched
        grown.insert(grown.end(), v.begin(), v.end());
        v = std::move(grown);
    }
    v.resize(count);
}

} // namespace gi
