#pragma once
// Large arrays that are read at random miss the TLB more often than the cache unless their pages are large.

#include <cstddef>
#include <vector>

namespace gi {

/// Asks the system to back these bytes with large pages as they are first touched; no more than a hint.
void advise_huge_pages(void* first, std::size_t bytes);

/// Reserve for `count` elements; to be called on an empty vector, before its pages are touched.
template <class T>
void reserve_huge_pages(std::vector<T>& v, std::size_t count)
{
    v.reserve(count);
    advise_huge_pages(v.data(), v.capacity() * sizeof(T));
}

} // namespace gi
