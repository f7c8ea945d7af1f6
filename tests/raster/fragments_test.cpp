#include "gi/raster/fragments.h"

#include <gtest/gtest.h>
#include <thread>

namespace gi::test {
namespace {

constexpr std::size_t kMany = 100000;

TEST(BorrowedFragments, KeepMemoryUntilItIsReleased)
{
    release_spare_fragments();
    { // nested, as when a waiting thread runs another task
        BorrowedFragments outer;
        EXPECT_EQ(outer->capacity, 0u);
        outer->reserve(kMany);
        BorrowedFragments inner;
        EXPECT_EQ(inner->capacity, 0u);
        inner->append(1, 2, 3);
        outer->append(4, 5, 6);
        EXPECT_EQ(outer->texel[0], 4u);
    }
    {
        BorrowedFragments large, small; // the outer one was returned last
        EXPECT_GE(large->capacity, kMany);
        EXPECT_EQ(large->count, 0u);
        EXPECT_GT(small->capacity, 0u);
        EXPECT_LT(small->capacity, kMany);
        release_spare_fragments(); // also what is borrowed
    }
    EXPECT_EQ(BorrowedFragments()->capacity, 0u);
    std::thread([] { BorrowedFragments()->reserve(kMany); }).join();
    release_spare_fragments();
    EXPECT_EQ(BorrowedFragments()->capacity, 0u);
}

} // namespace
} // namespace gi::test
