#pragma once
// What the posteriors of QUEST+ have in common (Watson 2017).

#include "study/numeric/error.h"

#include <cmath>
#include <vector>

namespace study {

inline double p_log2_p(double p) { return p > 0 ? p * std::log2(p) : 0; }

/// Entropy of an event of this probability, bits.
inline double entropy_of_event(double p) { return -p_log2_p(p) - p_log2_p(1 - p); }

/// Scales a posterior to the sum 1. @throws std::invalid_argument all of it is 0
inline void normalise(std::vector<double>& posterior)
{
    double sum = 0;
    for (double const v : posterior) sum += v;
    if (!(sum > 0))
        refuse("a response that no parameters of the grid allow", "the posterior would be empty",
               "include guess and lapse rates above 0");
    for (double& v : posterior) v /= sum;
}

} // namespace study
