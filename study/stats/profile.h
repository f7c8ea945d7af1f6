#pragma once
// Ends of an interval by profile likelihood: where the loss reaches a limit.

#include <algorithm>
#include <cmath>
#include <limits>

namespace study {

struct ProfileSearch {
    double best = 0;      ///< where the loss is 0
    double limit = 3.84;  ///< of the loss
    double direction = 1; ///< 1: the upper end, -1: the lower one
    double farthest = 8;  ///< ends beyond it, in this direction, are infinite
    double first_step = 0.1, tolerance = 2e-3;
};

/// @param loss twice the loss of log-likelihood at a value, which grows with the distance from `best`
template <class Loss>
double profile_end(ProfileSearch const& s, Loss const& loss)
{
    double inside = s.best, outside = inside, lost_inside = 0, lost = 0, step = s.first_step;
    while (lost < s.limit) {
        inside = outside;
        lost_inside = lost;
        outside += s.direction * step;
        if (s.direction * outside > s.direction * s.farthest)
            return s.direction * std::numeric_limits<double>::infinity();
        lost = loss(outside);
        // The loss grows about as the square of the distance.
        double const distance = std::abs(outside - s.best);
        step = lost > 0.05 ? std::clamp(distance * (std::sqrt(s.limit / lost) - 0.97), 0.2 * s.first_step,
                                        10 * s.first_step)
                           : 2 * step;
    }
    for (int i = 0; i < 20 && std::abs(outside - inside) > s.tolerance; ++i) {
        // Between the two by square roots, and never near the ends.
        double const a = std::sqrt(lost_inside), b = std::sqrt(lost);
        double const share = std::clamp((std::sqrt(s.limit) - a) / (b - a), 0.05, 0.95);
        double const middle = inside + share * (outside - inside), here = loss(middle);
        if (std::abs(here - s.limit) < 2e-3) return middle;
        (here < s.limit ? inside : outside) = middle;
        (here < s.limit ? lost_inside : lost) = here;
    }
    return inside + 0.5 * (outside - inside);
}

/// The limit of the likelihood ratio of a mean over n observers, for Student's interval with n - 1 degrees of
/// freedom: exact where observers' estimates are normal with equal variances, whether observers differ or not.
/// The variance between observers is estimated with the mean. If it is not 0, that limit is n log(1 + t^2 / (n -
/// 1)), and the ratio below is 1. If it is 0, observers differ by as much as or less than their trials explain;
/// the likelihood takes what the trials explain, Student's interval the ratio of it that was found. Taking the
/// former would make intervals too narrow where observers differ, but by too little to be seen in this sample.
/// @param ratio  variance of the mean by how observers differ, by that of the likelihood
/// @param n      1: chi-square's limit
double profile_limit(double confidence, double n, double ratio);

/// The limit of the likelihood ratio of a deviation between n observers, more than one, for the ends of the chi-square interval with
/// n - 1 degrees of freedom: exact where what deviates is known of each observer and normal.
/// @param tail  probability beyond the end: of the upper end as 0.025, of the lower one as 0.975
double deviation_limit(double n, double tail);

/// p of a value with this loss: 1 - the confidence whose limit is the loss, so that intervals
/// exclude the value where p is smaller.
double profile_p(double loss, double n, double ratio);

/// Few observers, and few answers that are not as expected (nearly perfect observers all seem equal), tell little
/// of the variance of a mean. This moves its ratio to that of the likelihood towards 1, the more the fewer there
/// are (as Smyth 2004, Stat. Appl. Genet. Mol. Biol. 3:3).
/// @param surprises  mean over observers of the sum of p (1 - p) of their trials
/// @param trials     mean over observers
double moderated(double ratio, double n, double surprises, double trials);

} // namespace study
