#pragma once
// Tests whether two noisy pictures estimate the same image. Per pixel and channel z = (x - r) / sqrt(var x + var r
// + e^2 (x^2 + r^2)), where e = 2^-23 bounds the rounding of floats.

#include <vector>

namespace gi {

struct ZTest {
    std::size_t count = 0; ///< values with a variance
    double mean_z = 0;     ///< mean of z; the most sensitive sign of a bias
    double beyond_2 = 0;   ///< fraction with |z| > 2; 0.0455 expected
    double beyond_3 = 0;   ///< fraction with |z| > 3; 0.0027 expected
    double largest = 0;    ///< largest |z|
    double sidak_p = 1;    ///< probability of a maximum |z| this large among `count` values (Sidak)
    double mean_p = 1;     ///< probability of a mean this far from 0, assuming independent values
    double chi2_p = 1;     ///< probability of a sum of z^2 this large or larger, assuming independent values
};

/// Two-sided probability of |z| or more under a normal distribution.
double two_sided_p(double z);

/// All arrays have the same length; reference_variance may be empty (exact reference). Values without variance
/// are omitted if they agree but for rounding.
ZTest z_test(std::vector<float> const& image, std::vector<float> const& variance,
             std::vector<float> const& reference, std::vector<float> const& reference_variance);

} // namespace gi
