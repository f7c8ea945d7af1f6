// Numbers as people read them.

#include "study/analysis/shown.h"

#include <gtest/gtest.h>
#include <limits>

namespace study::test {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

TEST(Shown, EstimatesHaveTheDigitsThatCarryTheirErrors)
{
    struct Case {
        double value, low, high;
        char const* text;
    };
    for (Case const& c :
         {Case{0.00465123, 0.00432987, 0.00497654, "0.00465 [0.00433, 0.00498]"},
          Case{2.5, 2.1, 2.9, "2.50 [2.10, 2.90]"}, Case{-8.624e-12, -0.31, 0.29, "0.00 [-0.31, 0.29]"},
          Case{-8.624e-12, -0.0312, 0.0297, "0.000 [-0.031, 0.030]"},
          Case{12345.678, 11000, 13700, "12346 [11000, 13700]"},
          Case{1e9 + 0.46, 1e9 + 0.1, 1e9 + 0.8, "1000000000.46 [1000000000.10, 1000000000.80]"},
          Case{4.65e-13, 4.33e-13, 4.98e-13, "4.65e-13 [4.33e-13, 4.98e-13]"},
          Case{4.65e-13, -4.33e-13, 1.4e-12, "4.7e-13 [-4.3e-13, 1.40e-12]"},
          Case{4.65e13, 4.33e13, 4.98e13, "4.65e+13 [4.33e+13, 4.98e+13]"},
          Case{0.75, 0.7, kNone, "0.750 [0.700, open]"}, Case{0.75, kNone, kNone, "0.75"},
          Case{0.1 + 0.2, kNone, kNone, "0.3"}, Case{kNone, kNone, kNone, "–"},
          Case{kNone, 2.6049, kNone, "– [2.605, open]"}, Case{0, 0, 0, "0 [0, 0]"},
          Case{0.5, 0.5, 0.5, "0.500000 [0.500000, 0.500000]"}, Case{0.00115385, 0, 0, "0.0012 [0.0000, 0.0000]"},
          Case{0.00115385, 0, 0.00115385, "0.00115 [0.00000, 0.00115]"},
          Case{99.96, 99.9, 100.05, "99.960 [99.900, 100.050]"}})
        EXPECT_EQ(shown_estimate(c.value, c.low, c.high), c.text);
}

TEST(Shown, NumbersHaveFourDigitsAndProbabilitiesThree)
{
    EXPECT_EQ(shown_number(0.0046512), "0.004651");
    EXPECT_EQ(shown_number(-1234.56), "-1235");
    EXPECT_EQ(shown_number(123.456), "123.5");
    EXPECT_EQ(shown_number(1e-12), "1e-12");
    EXPECT_EQ(shown_number(1000000000.46), "1e+09");
    EXPECT_EQ(shown_number(1234567890.0), "1.23456789e+09");
    EXPECT_EQ(shown_number(40), "40");
    EXPECT_EQ(shown_number(0), "0");
    EXPECT_EQ(shown_p(0.04961), "0.0496");
    EXPECT_EQ(shown_p(1e-5), "<0.001");
    EXPECT_EQ(shown_p(1), "1");
}

TEST(Shown, TablesJoinEstimatesAndIntervals)
{
    Table t;
    t.columns = {name_column("item", ""), estimate_column("score", ""), {"low", ""}, {"high", ""}, {"p", ""}};
    t.rows = {{"007", "0.00465", "0.00433", "0.00498", "0.0004"}, {"b", "n/a", "n/a", "n/a", "n/a"}};
    ShownTable const shown = shown_table(t);
    ASSERT_EQ(shown.columns.size(), 3u);
    EXPECT_EQ(shown.columns[1].name, "score [low, high]");
    EXPECT_TRUE(shown.columns[1].is_number);
    EXPECT_EQ(shown.rows[0], (std::vector<std::string>{"007", "0.00465 [0.00433, 0.00498]", "<0.001"}));
    EXPECT_EQ(shown.rows[1], (std::vector<std::string>{"b", "–", "–"}));
    EXPECT_EQ(full_cell(1e9 + 0.125), "1000000000.125");
    EXPECT_EQ(full_cell(0.1 + 0.2), "0.3");
}

} // namespace
} // namespace study::test
