#pragma once
// Sensitivity d' and bias of signal detection theory: equal variances, one decision axis. Models: Macmillan &
// Creelman 2005, "Detection Theory: A User's Guide", 2nd ed.; z is the normal quantile.

namespace study {

enum class Correction {
    none,      ///< rates of 0 or 1 give an infinite d'
    log_linear ///< (hits + 0.5) / (trials + 1) for both rates (Hautus 1995, BRMIC 27:46)
};

struct YesNo {
    double hit_rate, false_alarm_rate; ///< after correction
    double dprime;                     ///< z(H) - z(F)
    double criterion;                  ///< c = -(z(H) + z(F)) / 2; positive = "no" is preferred
    double beta;                       ///< exp((z(F)^2 - z(H)^2) / 2), the likelihood ratio at the criterion
    double standard_error; ///< of d' (Gourevitch & Galanter 1967, Psychometrika 32:25); infinite if d' is
};

/// @throws std::invalid_argument without signal trials or noise trials, or with more hits than signals
YesNo yes_no(double hits, double signals, double false_alarms, double noises,
             Correction correction = Correction::none);

/// d' of choosing the signal between two intervals, from the proportion correct: sqrt(2) z(p).
/// Negative below chance, infinite at 0 and 1. @throws std::invalid_argument p outside of [0, 1] or NaN
double two_interval_dprime(double proportion_correct);

/// Proportion correct of the odd one out of three (Frijters 1979, Br. J. Math. Stat. Psychol. 32:229):
/// p = 2 \int_0^inf phi(u) (Phi(-u sqrt 3 + d' sqrt(2/3)) + Phi(-u sqrt 3 - d' sqrt(2/3))) du,
/// which is 1 - 4 T(d'/sqrt 6, sqrt 3), T of Owen 1956.
double oddity_proportion(double dprime);
double oddity_miss(double dprime); ///< 1 - oddity_proportion, without cancellation

} // namespace study
