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

/// Decision strategy of an observer of pairs.
enum class Strategy {
    independent, ///< compares each observation with a criterion (optimal for same-different)
    differencing ///< compares differences between observations
};

/// d' of choosing the signal among m intervals or places, from the proportion correct:
/// p = \int phi(x - d') Phi(x)^(m-1) dx (Green & Swets 1966); for m = 2 this is sqrt(2) z(p).
/// Negative below chance, infinite at 0 and 1. @throws std::invalid_argument m < 2, p outside of [0, 1] or NaN
double mafc_dprime(double proportion_correct, int m);

/// d' of same-different, from the rates of "different" given different (hits) and given same (false alarms).
/// Differencing: H = Phi((d'-k)/sqrt 2) + Phi((-d'-k)/sqrt 2), F = 2 Phi(-k/sqrt 2). Independent:
/// d' = 2 z((1 + sqrt(2p - 1)) / 2) with the unbiased p = Phi((z(H) - z(F)) / 2). 0 where H <= F.
/// @throws std::invalid_argument rates outside of [0, 1] or NaN
double same_different_dprime(double hit_rate, double false_alarm_rate, Strategy strategy);

/// d' of ABX, from the unbiased proportion correct p = Phi((z(H) - z(F)) / 2) with
/// p = Phi(d'/sqrt 2) Phi(d'/s) + Phi(-d'/sqrt 2) Phi(-d'/s), s = 2 independent, sqrt 6 differencing.
/// @param hit_rate, false_alarm_rate  of saying "A" given X = A, given X = B. 0 where H <= F.
double abx_dprime(double hit_rate, double false_alarm_rate, Strategy strategy);

/// d' of the odd one out of three (Frijters 1979, Br. J. Math. Stat. Psychol. 32:229):
/// p = 2 \int_0^inf phi(u) (Phi(-u sqrt 3 + d' sqrt(2/3)) + Phi(-u sqrt 3 - d' sqrt(2/3))) du.
/// 0 at or below chance (1/3), infinite at 1.
double oddity_dprime(double proportion_correct);

/// Proportions correct for a given d': inverses of mafc_dprime and oddity_dprime.
double mafc_proportion(double dprime, int m);
/// 1 - 4 T(d'/sqrt 6, sqrt 3), T of Owen 1956, which is Frijters' integral.
double oddity_proportion(double dprime);
double oddity_miss(double dprime); ///< 1 - oddity_proportion, without cancellation

} // namespace study
