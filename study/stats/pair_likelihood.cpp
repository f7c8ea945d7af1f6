#include "study/stats/pair_likelihood.h"

#include "study/numeric/special.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace study {
namespace {

/// F, its density, and log F, accurate in small tails.
struct Link {
    PairModel model;
    double log_cdf(double z) const
    {
        if (model == PairModel::thurstone_v) return log_normal_cdf(z);
        return z > 0 ? -std::log1p(std::exp(-z)) : z - std::log1p(std::exp(z));
    }
    double density(double z) const
    {
        if (model == PairModel::thurstone_v) return normal_pdf(z);
        double const e = std::exp(-std::abs(z));
        return e / ((1 + e) * (1 + e));
    }
};

double x_log_y(double x, double log_y) { return x == 0 ? 0 : x * log_y; }

} // namespace

void add_pair(PairModel model, PairParameters const& layout, PairCount const& pair, std::span<double const> at,
              Likelihood& l)
{
    Link const link{model};
    std::array<std::size_t, 4> index{};
    std::array<double, 4> factor{}; // of z
    std::size_t used = 0;
    double z = 0;
    auto const depend = [&](std::size_t parameter, double by) {
        z += by * at[parameter];
        index[used] = parameter;
        factor[used++] = by;
    };
    if (pair.first > 0) depend(std::size_t(pair.first) - 1, 1);
    if (pair.second > 0) depend(std::size_t(pair.second) - 1, -1);
    if (layout.has_order) depend(layout.order_at(), 1);
    double const t = layout.has_threshold ? at[layout.threshold_at()] : 0;
    double const half = layout.has_threshold ? 0 : pair.ties / 2;
    std::array<double, 3> const count{pair.first_wins + half, pair.second_wins + half,
                                      layout.has_threshold ? pair.ties : 0};
    double const n = count[0] + count[1] + count[2];

    double const log_p0 = link.log_cdf(z - t), log_p1 = link.log_cdf(-z - t);
    double const f0 = link.density(z - t), f1 = link.density(-z - t);
    double const p2 = layout.has_threshold ? std::max(1e-300, 1 - std::exp(log_p0) - std::exp(log_p1)) : 1;
    std::array<double, 3> const log_p{log_p0, log_p1, std::log(p2)};
    std::array<double, 3> const by_z{f0, -f1, f1 - f0}, by_t{-f0, -f1, f0 + f1};
    if (layout.has_threshold) {
        index[used] = layout.threshold_at();
        factor[used++] = 0;
    }
    for (std::size_t o = 0; o < (layout.has_threshold ? 3u : 2u); ++o) {
        double const p = std::exp(log_p[o]);
        l.log_likelihood += x_log_y(count[o], log_p[o]);
        for (std::size_t a = 0; a < used; ++a) {
            bool const a_is_t = layout.has_threshold && a + 1 == used;
            double const slope_a = a_is_t ? by_t[o] : by_z[o] * factor[a];
            if (p > 0) l.gradient[index[a]] += count[o] * slope_a / p;
            for (std::size_t b = 0; b < used; ++b) {
                bool const b_is_t = layout.has_threshold && b + 1 == used;
                double const slope_b = b_is_t ? by_t[o] : by_z[o] * factor[b];
                if (p > 0) l.information(index[a], index[b]) += n * slope_a * slope_b / p;
            }
        }
    }
}

} // namespace study
