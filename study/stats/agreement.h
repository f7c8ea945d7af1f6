#pragma once
// Do observers agree, and are there differences at all? For choices between pairs and for ranks.

#include "study/numeric/matrix.h"

#include <span>

namespace study {

/// Kendall's coefficient of agreement between m observers who each judged every pair of n items once (Kendall &
/// Babington Smith 1940, Biometrika 31:324): u = 2 S / (C(m, 2) C(n, 2)) - 1, S = sum over i != j of C(a_ij, 2).
struct KendallU {
    int observers = 0, items = 0;
    double u = 0;       ///< 1 = all agree
    double minimum = 0; ///< -1/(m-1) for even m, -1/m for odd m
    /// 4/(m-2) (S - C(n, 2) C(m, 2) (m-3)/(m-2) / 2), and with S - 1 for S; NaN for m = 2.
    double chi_square = 0, chi_square_corrected = 0;
    double degrees_of_freedom = 0; ///< C(n, 2) m (m-1) / (m-2)^2
    double p = 1, p_corrected = 1; ///< under random choices
};
/// @param wins  wins(i, j) + wins(j, i) = m for all pairs. @throws std::invalid_argument otherwise; m < 2; n < 2
KendallU kendall_u(Matrix const& wins);

/// Are all items equally good? D = 4 (sum a_i^2 - m^2 n (n-1)^2 / 4) / (m n), chi-square with n - 1 degrees (David
/// 1988, "The Method of Paired Comparisons"). Two scores further apart than `range` differ significantly:
/// R = W sqrt(m n) / 2 + 1/4, W the 1 - level quantile of the range of n normal numbers
/// (Starks & David 1961, Biometrika 48:95).
struct EqualityTest {
    std::vector<double> score; ///< wins of each item
    double d = 0;
    int degrees_of_freedom = 0;
    double p = 1;
    double studentized_range = 0; ///< W
    double range = 0;             ///< R
};
/// @throws as kendall_u, but m may be 1
EqualityTest equality_test(Matrix const& wins, double level = 0.05);

/// Do n conditions differ, by the ranks that m observers (blocks) gave them? Friedman 1937 (JASA 32:675), with the
/// correction for ties; W = chi^2 / (m (n - 1)) is Kendall's coefficient of concordance.
struct Friedman {
    int observers = 0, conditions = 0;
    int left_out = 0; ///< observers with a missing value (NaN)
    bool is_tied = false; ///< every observer ties everything
    double chi_square = 0;
    int degrees_of_freedom = 0;
    double p = 1;
    double kendall_w = 0;
    std::vector<double> mean_rank; ///< per condition, from 1
};
/// If every observer ties everything, chi-square and W are 0 and p is 1.
/// @param values  observers x conditions; larger = larger rank. @throws std::invalid_argument no complete
/// observer, fewer than two conditions
Friedman friedman(Matrix const& values);

/// Ranks from 1 up; values that are equal but for rounding share their mean rank.
std::vector<double> midranks(std::span<double const> values);

} // namespace study
