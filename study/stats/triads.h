#pragma once
// Circular triads of one observer's choices, a > b > c > a (Kendall & Babington Smith 1940, Biometrika 31:324):
//   T = C(n, 3) - sum_i C(s_i, 2), s_i the wins of item i;  zeta = 1 - T / T_max,
// T_max = (n^3 - n) / 24 for odd n, (n^3 - 4n) / 24 for even n. zeta is 1 for choices without a contradiction.

#include "study/stats/matrix.h"

#include <cstdint>

namespace study {

struct CircularTriads {
    int count = 0; ///< T
    int maximum = 0;
    double expected = 0;           ///< under random choices: C(n, 3) / 4
    double zeta = 1;               ///< NaN for fewer than three items, which have no triads
    double p = 1;                  ///< P(T or fewer under random choices): small = consistent choices. Exact up to
                                   ///< kExactTriadItems items, by chi-square beyond
    double chi_square = 0;         ///< 8/(n-4) (C(n, 3)/4 - T - 1/2) + df, NaN for n <= 4
    double degrees_of_freedom = 0; ///< n(n-1)(n-2)/(n-4)^2, NaN for n <= 4
};

inline constexpr int kExactTriadItems = 10;

/// @param prefers  n x n: prefers(i, j) = 1 and prefers(j, i) = 0 if i was chosen over j; the diagonal is 0
/// @throws std::invalid_argument a pair without a choice, no items, or a table that is not square
CircularTriads circular_triads(Matrix const& prefers);

/// Number of the 2^(n(n-1)/2) outcomes with T = 0, 1, ... circular triads. @param n 1 to kExactTriadItems
std::vector<std::uint64_t> circular_triad_counts(int n);

} // namespace study
