#pragma once
// Thurstone scaling with the distance prior of pwcmp ("gaussian"; Perez-Ortiz & Mantiuk 2017, arXiv:1712.03686):
// it maximises, over all ordered pairs c = (i, j) that met,
//   sum_c (D_ij log P_c + D_ji log(1 - P_c) + log(0.1 + r_c)),  P_c = Phi((q_i - q_j) / 1.4826),
//   r_c = sum_c' a_c'(c) / sum_c'' a_c'(c''),  a_c'(c) = P_c^k' (1 - P_c)^(n' - k'),
// where k' of n' are the wins of pair c', changed by one if they were unanimous. The prior prefers scores whose
// distances resemble those of other pairs, which moves unanimous pairs closer. It serves for comparison with that
// program: if every pair was unanimous it has no finite maximum, whereas fit_pairs has one.

#include "study/numeric/matrix.h"

namespace study {

/// Scores in JOD, mean 0.  @throws std::invalid_argument as pairs_of;
/// items that are not connected; no finite maximum
std::vector<double> scale_with_distance_prior(Matrix const& wins);

} // namespace study
