// Latin and Williams squares.

#include "study/plan/squares.h"

#include <map>
#include <set>

namespace study::test {
namespace {

void expect_every_item_once_in_every_place(Square const& square, int n)
{
    int const times = int(square.size()) / n;
    for (int place = 0; place < n; ++place) {
        std::map<int, int> count;
        for (auto const& row : square) ++count[row[std::size_t(place)]];
        ASSERT_EQ(int(count.size()), n);
        for (auto const& [unused, k] : count) EXPECT_EQ(k, times);
    }
    for (auto const& row : square) EXPECT_EQ(int(std::set<int>(row.begin(), row.end()).size()), n);
}

TEST(LatinSquare, HasEveryItemOnceInEveryPlace)
{
    for (int n = 1; n <= 30; ++n) {
        EXPECT_EQ(int(latin_square(n).size()), n);
        expect_every_item_once_in_every_place(latin_square(n), n);
    }
}

TEST(WilliamsSquare, HasEveryOrderedNeighbourOnceOrTwiceWhereOdd)
{
    for (int n = 2; n <= 30; ++n) {
        Square const square = williams_square(n);
        bool const is_odd = n % 2 == 1;
        EXPECT_EQ(int(square.size()), is_odd ? 2 * n : n);
        expect_every_item_once_in_every_place(square, n);
        std::map<std::pair<int, int>, int> neighbours;
        for (auto const& row : square)
            for (std::size_t i = 1; i < row.size(); ++i) ++neighbours[{row[i - 1], row[i]}];
        EXPECT_EQ(int(neighbours.size()), n * (n - 1)) << n;
        for (auto const& [unused, k] : neighbours) EXPECT_EQ(k, is_odd ? 2 : 1) << n;
    }
}

TEST(WilliamsSquare, IsTheKnownOneOfFour)
{
    EXPECT_EQ(williams_square(4), (Square{{0, 1, 3, 2}, {1, 2, 0, 3}, {2, 3, 1, 0}, {3, 0, 2, 1}}));
    EXPECT_EQ(williams_square(1), (Square{{0}}));
}

} // namespace
} // namespace study::test
