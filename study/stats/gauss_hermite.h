#pragma once
// Nodes x and weights w of Gauss and Hermite: the integral of exp(-x^2) f(x) is about the sum of w f(x), exact for
// polynomials of degree 2 n - 1.

#include <vector>

namespace study {

struct QuadratureNode {
    double x = 0, weight = 0;
    double log_weight = 0; ///< log(weight) + x^2: of a rule for the integral of f itself
};
/// @param n 1 to 40
std::vector<QuadratureNode> gauss_hermite(int n);

} // namespace study
