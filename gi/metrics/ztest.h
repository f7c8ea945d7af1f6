#pragma once
// Are two noisy pictures of one truth? Per pixel and channel z = (x - r) / sqrt(var x + var r).

#include <vector>

namespace gi {

struct ZTest {
    std::size_t count = 0; ///< values with a variance
    double mean_z = 0;     ///< of z; a bias shows here first
    double beyond_2 = 0;   ///< share with |z| > 2; 0.0455 expected
    double beyond_3 = 0;   ///< share with |z| > 3; 0.0027 expected
    double largest = 0;    ///< |z|
    double sidak_p = 1;    ///< probability of such a largest |z| among `count` (Sidak)
    double mean_p = 1;     ///< probability of such a mean, values taken as independent
    double chi2_p = 1;     ///< probability of such a sum of z^2 or a larger one, values taken as independent
};

/// Two-sided probability of |z| or more under a normal distribution.
double two_sided_p(double z);

/// All arrays are equally long; reference_variance may be empty (an exact reference). Values without variance that
/// agree are left out; those that differ count as |z| = infinity.
ZTest z_test(std::vector<float> const& image, std::vector<float> const& variance,
             std::vector<float> const& reference, std::vector<float> const& reference_variance);

} // namespace gi
