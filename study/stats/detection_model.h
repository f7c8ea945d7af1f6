#pragma once
// How sensitivity d' and criterion c of one observer determine the answers in tasks of detection: equal variances,
// one decision axis (Macmillan & Creelman 2005). Hits and false alarms are "yes" with and without a signal,
// "different" of different and equal stimuli, "first" where it is right and where it is wrong.
//
//   yes/no          z(H) = d'/2 - c,          z(F) = -d'/2 - c
//   2-AFC           z(H) = d'/sqrt 2 - c,     z(F) = -d'/sqrt 2 - c
//   ABX             z(H) = z(p) - c,          z(F) = -z(p) - c,   p(d') of the differencing observer (dprime.h)
//   same-different  H = Phi((d' - k)/sqrt 2) + Phi((-d' - k)/sqrt 2),  F = 2 Phi(-k/sqrt 2) = Phi(-c)
//   oddity of three p = 1 - 4 T(d'/sqrt 6, sqrt 3), T of Owen (1956): the integral of Frijters 1979; no criterion
//
// In the last three H does not depend on the sign of d'. A negative d' here stands for answers below chance, which
// samples of observers without sensitivity give as often as those above: z(H) is reflected at its value for d' =
// 0. So estimates are not cut off at 0, and their means over observers are not biased upwards.

namespace study {

enum class DetectionTask { yes_no, two_interval, same_different, abx, oddity };
inline constexpr bool has_criterion(DetectionTask task) { return task != DetectionTask::oddity; }

/// Answers of one observer in one condition. Oddity: hits = right answers, signals = trials.
struct DetectionCounts {
    double hits = 0, signals = 0, false_alarms = 0, noises = 0;
};

/// A probability, its complement without cancellation, and its derivatives.
struct DetectionRate {
    double yes = 0, no = 1, by_dprime = 0, by_criterion = 0;
};
struct DetectionRates {
    DetectionRate hit, false_alarm;
};

DetectionRates detection_rates(DetectionTask task, double dprime, double criterion);

/// Log-likelihood without its constant, its gradient, and Fisher's information (dd, dc, cc).
struct DetectionLikelihood {
    double value = 0;
    double by_dprime = 0, by_criterion = 0;
    double information[3] = {0, 0, 0};
};
DetectionLikelihood detection_likelihood(DetectionTask task, DetectionCounts const& counts, double dprime,
                                         double criterion);

/// d' and c that the rates, with half an answer added to each kind, give exactly: a start for fits. d' is negative
/// below chance, and at most 8 in size.
struct DetectionPoint {
    double dprime = 0, criterion = 0;
};
DetectionPoint detection_point(DetectionTask task, DetectionCounts const& counts);

} // namespace study
