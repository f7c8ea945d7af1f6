// Loss and order from a sender's counter.

#include "viewer/devices/tracking/sequence.h"

#include <gtest/gtest.h>

namespace viewer::test {
namespace {

TrackerCounts counts_of(std::vector<std::uint64_t> const& frames)
{
    Sequence s;
    TrackerCounts c;
    for (std::uint64_t const f : frames) s.note(f, c);
    return c;
}

TEST(Sequence, CountsLossOrderAndRestarts)
{
    EXPECT_EQ(counts_of({5, 6, 7}), TrackerCounts{});
    EXPECT_EQ(counts_of({5, 8}).lost, 2u);
    TrackerCounts c = counts_of({5, 8, 7});
    EXPECT_EQ(c.lost, 1u);
    EXPECT_EQ(c.out_of_order, 1u);
    c = counts_of({5, 8, 7, 7, 8});
    EXPECT_EQ(c.duplicate, 2u);
    c = counts_of({5, 4, 6}); // 4 was never missed
    EXPECT_EQ(c.lost, 0u);
    EXPECT_EQ(c.out_of_order, 1u);
    c = counts_of({100000, 1, 2});
    EXPECT_EQ(c.restarts, 1u);
    EXPECT_EQ(c.lost, 0u);
    c = counts_of({1, 100000});
    EXPECT_EQ(c.restarts, 1u);
}

TEST(Sequence, NumbersAreSeenOnceHoweverLongItRuns)
{
    Sequence s;
    TrackerCounts c;
    for (std::uint64_t f = 0; f < 5000; ++f)
        if (f % 10 != 3) {
            EXPECT_EQ(s.note(f, c), Arrival::in_order);
        }
    EXPECT_EQ(c.lost, 500u);
    EXPECT_EQ(s.note(4993, c), Arrival::late);
    EXPECT_EQ(s.note(4993, c), Arrival::duplicate);
    EXPECT_EQ(s.note(4994, c), Arrival::duplicate);
    EXPECT_EQ(c.lost, 499u);
}

} // namespace
} // namespace viewer::test
