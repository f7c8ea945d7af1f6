// Special functions against values printed in tables and against each other.

#include "study/numeric/special.h"

#include "tests/study_stats/support/study_data.h"

#include <cmath>
#include <numbers>

namespace study::test {
namespace {

TEST(Special, NormalDistributionIsThatOfTables)
{
    EXPECT_NEAR(normal_cdf(1.96), 0.9750021048517795, 1e-15);
    EXPECT_NEAR(normal_quantile(0.75), 0.6744897501960817, 1e-15);
    EXPECT_NEAR(normal_quantile(0.975), 1.959963984540054, 1e-14);
    EXPECT_NEAR(normal_quantile(1e-20), -9.262340089798408, 1e-12);
    EXPECT_EQ(normal_quantile(0.5), 0);
    EXPECT_TRUE(std::isinf(normal_quantile(0)) && std::isinf(normal_quantile(1)));
    EXPECT_TRUE(std::isnan(normal_quantile(-0.1)) && std::isnan(normal_quantile(NAN)));
    for (double z : {-8.0, -3.3, -0.7, 0.0, 1e-9, 2.0}) EXPECT_NEAR(normal_quantile(normal_cdf(z)), z, 1e-9) << z;
}

TEST(Special, LogOfTheNormalDistributionGoesOnWhereThatIsNought)
{
    for (double z : {-29.9, -20.0, -3.0, 0.0, 4.0, 5.5})
        EXPECT_NEAR(log_normal_cdf(z), std::log(normal_cdf(z)), 1e-12 * (1 + z * z)) << z;
    EXPECT_NEAR(log_normal_cdf(-30.0001) - log_normal_cdf(-29.9999), -0.0002 * 30.0333, 2e-6);
    EXPECT_NEAR(log_normal_cdf(-40), -804.6084420137538, 1e-9);
    EXPECT_NEAR(log_normal_cdf(8), -normal_cdf(-8), 1e-28);
}

TEST(Special, ChiSquareAndStudentMeetTheirClosedForms)
{
    for (double x : {1e-6, 0.3, 1.0, 5.0, 40.0}) {
        EXPECT_NEAR(chi_square_tail(2 * x, 2), std::exp(-x), 1e-14);
        EXPECT_NEAR(chi_square_tail(2 * x, 1), std::erfc(std::sqrt(x)), 1e-14);
    }
    for (double t : {-30.0, -2.0, -0.01, 0.0, 0.7, 5.0}) {
        EXPECT_NEAR(student_cdf(t, 1), 0.5 + std::atan(t) / std::numbers::pi, 1e-14);
        EXPECT_NEAR(student_cdf(t, 2), 0.5 + t / (2 * std::sqrt(2 + t * t)), 1e-14);
        EXPECT_NEAR(student_cdf(t, 1e7), normal_cdf(t), 1e-7);
    }
    for (double p : {1e-12, 0.025, 0.3, 0.975})
        for (double n : {1.0, 2.5, 40.0, 1e4}) EXPECT_NEAR(student_cdf(student_quantile(p, n), n) / p, 1, 1e-11);
}

TEST(Special, EndsAndNonsenseAreInfiniteOrNaN)
{
    double const nan = std::nan("");
    EXPECT_EQ(normal_quantile(0), -kInfinity);
    EXPECT_EQ(student_quantile(1, 3), kInfinity);
    EXPECT_EQ(student_cdf(-kInfinity, 3), 0);
    EXPECT_EQ(chi_square_tail(kInfinity, 3), 0);
    for (double p : {-0.1, 1.1, nan})
        EXPECT_TRUE(std::isnan(student_quantile(p, 3)) && std::isnan(normal_quantile(p)));
    for (double n : {-1.0, 0.0, nan})
        EXPECT_TRUE(std::isnan(student_cdf(1, n)) && std::isnan(student_quantile(0.3, n)));
}

TEST(Special, ChiSquareAndStudentAreThoseOfTables)
{
    EXPECT_NEAR(chi_square_tail(3.841458820694124, 1), 0.05, 1e-14);
    EXPECT_NEAR(chi_square_tail(18.307038053275146, 10), 0.05, 1e-13);
    EXPECT_EQ(chi_square_tail(0, 3), 1);
    EXPECT_EQ(chi_square_tail(1, 0), 0);
    EXPECT_NEAR(student_quantile(0.975, 25), 2.059538552753294, 1e-12);
    EXPECT_NEAR(student_quantile(0.025, 1), -12.706204736174698, 1e-9);
    EXPECT_NEAR(student_cdf(-2.059538552753294, 25), 0.025, 1e-13);
    EXPECT_TRUE(std::isnan(chi_square_tail(NAN, 2)) && std::isnan(student_cdf(NAN, 2)));
}

TEST(Special, RangeOfNormalNumbersIsThatOfR)
{
    LIGHTWELL_NEED_STUDY_DATA();
    auto const expected = read_json("sdt_and_constants.expected.json")["studentized_range_q95_inf_df"];
    for (std::size_t i = 0; i < expected["k"].size(); ++i)
        EXPECT_NEAR(normal_range_quantile(0.95, expected["k"][i]), double(expected["q"][i]), 1e-6) << i;
    EXPECT_EQ(normal_range_cdf(0, 4), 0);
}

} // namespace
} // namespace study::test
