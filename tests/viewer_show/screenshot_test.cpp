#include "viewer/app/screenshot.h"

#include <gtest/gtest.h>

namespace viewer::test {
namespace {

TEST(Screenshot, PicturesStandBesideEachOther)
{
    Snapshot const low{{2, 1}, {1, 2, 3, 4, 5, 6}}, high{{1, 2}, {7, 8, 9, 10, 11, 12}};
    std::vector<Snapshot> const parts{low, high};
    Snapshot const both = side_by_side(parts);
    EXPECT_EQ(both.size_px, glm::ivec2(3, 2));
    EXPECT_EQ(both.bytes, (std::vector<unsigned char>{1, 2, 3, 4, 5, 6, 7, 8, 9, 0, 0, 0, 0, 0, 0, 10, 11, 12}));
    std::vector<Snapshot> const one{low};
    EXPECT_EQ(side_by_side(one).bytes, low.bytes);
    EXPECT_TRUE(Snapshot{}.empty());
}

} // namespace
} // namespace viewer::test
