#pragma once
// Proportions, k of n trials: confidence intervals and the exact test. Without trials the interval is [0, 1].

namespace study {

struct Interval {
    double low = 0, high = 0;
};

/// The score interval (Wilson 1927, JASA 22:209). k and n need not be whole: ties count half.
/// @throws std::invalid_argument unless 0 <= k <= n and 0 < confidence < 1; NaN is refused
Interval wilson(double k, double n, double confidence = 0.95);

/// log P(K = k) for n trials of probability p; -infinity if impossible. @throws as wilson
double log_binomial(double k, double n, double p);
/// p-value of the exact two-sided test of "the probability is p": the sum over all outcomes that are not more
/// likely than k; 1 without trials. @throws std::invalid_argument unless 0 <= k <= n and p is in [0, 1]
double binomial_test(int k, int n, double p = 0.5);

} // namespace study
