#pragma once
// Huge pages for large arrays: random reads from small pages would miss the TLB more often than the cache.

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace gi {

/// Hints to the operating system to back these bytes with huge pages when they are first touched.
void advise_huge_pages(void* first, std::size_t bytes);

/// v.resize(count), with huge pages for any new memory.
template <class T, class Allocator>
void resize_on_huge_pages(std::vector<T, Allocator>& v, std::size_t count)
{
    if (count > v.capacity()) {
        std::vector<T, Allocator> grown;
        grown.reserve(std::max(count, 2 * v.size()));
        advise_huge_pages(grown.data(), grown.capacity() * sizeof(T)); // before the pages are first touched
        grown.insert(grown.end(), v.begin(), v.end());
        v = std::move(grown);
    }
    v.resize(count);
}

} // namespace gi
