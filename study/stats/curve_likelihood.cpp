#include "study/stats/curve_likelihood.h"

#include "study/adaptive/sigmoid.h"
#include "study/numeric/special.h"

#include <algorithm>
#include <cmath>

namespace study {
namespace {

void add_beta_binomial(LevelAnswers const& l, double p, double q, double nu, LevelLikelihood& sum, double& pull)
{
    // Gamma functions of whole numbers of trials are products.
    auto const right = int(l.right + 0.5), all = int(l.trials + 0.5);
    double product = 1;
    for (int i = 0; i < all; ++i) {
        bool const is_right = i < right;
        double const k = is_right ? i : i - right, share = is_right ? p : q, here = nu * share + k;
        product *= here / (nu + i);
        pull += (is_right ? nu : -nu) / here;
        sum.by_nu += share / here - 1 / (nu + i);
        if (product < 1e-200) {
            sum.value += std::log(product);
            product = 1;
        }
    }
    sum.value += std::log(product);
}

} // namespace

std::optional<LevelCurve> level_curve(Sigmoid kind, double proportion, double scale, double lapse, double guess,
                                      double eta)
{
    LevelCurve c{kind, scale, lapse, guess, kInfinity, 0, 0, 0};
    double const span = 1 - guess - lapse, share = (proportion - guess) / span;
    if (!(span > 0 && share > 1e-9 && share < 1 - 1e-9 && scale > 0)) return {};
    c.offset = sigmoid_quantile(kind, share);
    double const slope = 1 / sigmoid(kind, c.offset).density;
    c.offset_by_lapse = slope * share / span;
    c.offset_by_guess = slope * (share - 1) / span;
    if (eta > 0) {
        double const e = std::max(kLeastEta, eta);
        c.nu = 1 / (e * e) - 1;
    }
    return c;
}

double nu_by_logit(double eta) { return eta > kLeastEta ? -2 * (1 - eta) / (eta * eta) : 0; }

LevelLikelihood level_likelihood(std::span<LevelAnswers const> levels, LevelCurve const& c, double threshold,
                                 bool with_curve)
{
    LevelLikelihood s;
    double const span = 1 - c.guess - c.lapse;
    for (LevelAnswers const& l : levels) {
        double const away = (l.u - threshold) / c.scale;
        SigmoidValue const f = sigmoid(c.kind, away + c.offset);
        double const p = std::max(1e-12, c.guess + span * f.below), q = std::max(1e-12, c.lapse + span * f.above);
        double pull = 0, inflation = 1;
        if (l.trials < 2 || std::isinf(c.nu)) {
            double const wrong = l.trials - l.right;
            s.value += (l.right > 0 ? l.right * std::log(p) : 0) + (wrong > 0 ? wrong * std::log(q) : 0);
            pull = l.right / p - wrong / q;
        } else {
            add_beta_binomial(l, p, q, c.nu, s, pull);
            inflation = 1 + (l.trials - 1) / (c.nu + 1);
        }
        s.surprises += l.trials * p * q;
        double const by_z = span * f.density, by_threshold = -by_z / c.scale;
        s.by_threshold += pull * by_threshold;
        s.information += l.trials / (p * q * inflation) * by_threshold * by_threshold;
        if (!with_curve) continue;
        s.by_log_scale -= pull * by_z * away;
        s.by_lapse += pull * (-f.below + by_z * c.offset_by_lapse);
        s.by_guess += pull * (f.above + by_z * c.offset_by_guess);
    }
    return s;
}

} // namespace study
