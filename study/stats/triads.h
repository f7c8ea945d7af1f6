#pragma once
// Circular triads of one observer's choices, a > b > c > a (Kendall & Babington Smith 1940, Biometrika 31:324):
//   T = C(n, 3) - sum_i C(s_i, 2), s_i the wins of item i;  zeta = 1 - T / T_max is 1 for choices without a contradiction,
//   T_max = (n^3 - n) / 24 for odd n, (n^3 - 4n) / 24 for even n.

#include "study/numeric/matrix.h"

namespace study {

struct CircularTriads {
    int count = 0; ///< T
    int maximum = 0;
};

/// @param prefers  n x n: prefers(i, j) = 1 and prefers(j, i) = 0 if i was chosen over j; the diagonal is 0
/// @throws std::invalid_argument a pair without a choice, no items, or a table that is not square
CircularTriads circular_triads(Matrix const& prefers);

} // namespace study
