#pragma once
// Output of a rasteriser: one fragment for each triangle over each texel centre, in no particular order of texels.

#include "gi/raster/grid.h"

#include <memory>

namespace gi {

/// Three arrays of `count` fragments. The arrays grow by doubling and are never initialised.
struct Fragments {
    std::unique_ptr<std::uint32_t[]> texel;     ///< j * width + i
    std::unique_ptr<float[]> depth;             ///< along the axis, m
    std::unique_ptr<std::uint32_t[]> primitive; ///< index of the triangle, with bit kAlongAxis
    std::size_t count = 0, capacity = 0;

    /// Reserves memory for `more` additional fragments.
    void reserve(std::size_t more)
    {
        if (count + more > capacity) grow(count + more);
    }
    void append(std::uint32_t at, float depth_m, std::uint32_t id)
    {
        reserve(1);
        texel[count] = at;
        depth[count] = depth_m;
        primitive[count++] = id;
    }

private:
    void grow(std::size_t needed);
};

/// Fragments that are empty at first, with memory that earlier ones have used, of any thread.
class BorrowedFragments {
public:
    BorrowedFragments();
    ~BorrowedFragments();
    BorrowedFragments(BorrowedFragments const&) = delete;
    BorrowedFragments& operator=(BorrowedFragments const&) = delete;

    Fragments& operator*() { return fragments_; }
    Fragments* operator->() { return &fragments_; }

private:
    Fragments fragments_;
    unsigned since_ = 0; ///< number of calls of release_spare_fragments() before
};

/// Frees the memory that waits for BorrowedFragments, and that of those in use when they end:
/// the next ones may be far smaller.
void release_spare_fragments();

} // namespace gi
