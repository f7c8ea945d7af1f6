// Intervals and tests of proportions against published numbers.

#include "study/stats/binomial.h"

#include "study/numeric/special.h"

#include <cmath>
#include <gtest/gtest.h>

namespace study::test {
namespace {

TEST(Binomial, IntervalsAreThoseOfNewcombe)
{
    // Newcombe 1998 (Stat. Med. 17:857), table I, method 3.
    struct Row {
        double k, n, wilson_low, wilson_high;
    };
    for (Row const& r : {Row{81, 263, 0.2553, 0.3662}, Row{15, 148, 0.0624, 0.1605}, Row{0, 20, 0.0, 0.1611},
                         Row{1, 29, 0.0061, 0.1718}}) {
        Interval const w = wilson(r.k, r.n);
        EXPECT_NEAR(w.low, r.wilson_low, 6e-5);
        EXPECT_NEAR(w.high, r.wilson_high, 6e-5);
    }
}

TEST(Binomial, TestSumsWhatIsNotMoreLikely)
{
    EXPECT_NEAR(binomial_test(8, 10), 0.109375, 1e-12);
    EXPECT_NEAR(binomial_test(5, 10), 1, 1e-12);
    EXPECT_NEAR(binomial_test(3, 5, 0.2), 0.05792, 1e-12); // only the upper tail is as unlikely
    EXPECT_EQ(binomial_test(0, 0), 1);
}

TEST(Binomial, WithoutTrialsNothingIsKnown)
{
    EXPECT_EQ(wilson(0, 0).low, 0);
    EXPECT_EQ(wilson(0, 0).high, 1);
    EXPECT_EQ(wilson(5, 5).high, 1);
}

TEST(Binomial, RefusesWhatIsNoCount)
{
    EXPECT_THROW(wilson(3, 2), std::invalid_argument);
    EXPECT_THROW(wilson(NAN, 2), std::invalid_argument);
    EXPECT_THROW(wilson(-1, 2), std::invalid_argument);
    EXPECT_THROW(wilson(1, 2, 95), std::invalid_argument);
    EXPECT_THROW(binomial_test(1, 2, 1.5), std::invalid_argument);
}

} // namespace
} // namespace study::test
