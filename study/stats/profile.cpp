#include "study/stats/profile.h"

#include "study/stats/special.h"

namespace study {

double profile_limit(double confidence, double n, double share)
{
    double const z = normal_quantile((1 + confidence) / 2);
    if (!(n > 1)) return z * z;
    double const t = student_quantile((1 + confidence) / 2, n - 1), same = 1 - share;
    double const too_wide = 0.1 * std::max(0.0, 1 - 5 / n) * same * same * same;
    double const students = 1 - same * same * same * same;
    return z * z * (1 - too_wide) + students * (n * std::log1p(t * t / (n - 1)) - z * z);
}

} // namespace study
