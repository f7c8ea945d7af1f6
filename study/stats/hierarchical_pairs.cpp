#include "study/stats/hierarchical_pairs.h"

#include "study/numeric/error.h"
#include "study/numeric/special.h"

#include <algorithm>
#include <cmath>

namespace study {
namespace {

constexpr double kScorePrior = 2, kSdPrior = 0.7, kTiePrior = 0.3;

/// Parameters: scores of items 1, 2, ... relative to item 0; log sd; log t if there are ties;
/// z by observer and item.
struct HierarchyLayout {
    std::size_t items = 0, observers = 0;
    bool has_ties = false;

    std::size_t sd_at() const { return items - 1; }
    std::size_t tie_at() const { return items; }
    std::size_t own_at(std::size_t observer) const { return items + has_ties + observer * items; }
    std::size_t count() const { return own_at(observers); }
};

double score_at(std::span<double const> x, std::size_t item) { return item == 0 ? 0 : x[item - 1]; }

/// phi(z) / Phi(z).
double hazard(double z, double log_cdf) { return std::exp(-0.5 * z * z - kLogRootTwoPi - log_cdf); }

class HierarchyDensity {
public:
    HierarchyDensity(HierarchyLayout layout, std::vector<std::vector<PairCount>> pairs)
        : layout_(layout), pairs_(std::move(pairs))
    {
    }

    double operator()(std::span<double const> x, std::span<double> g) const
    {
        std::fill(g.begin(), g.end(), 0.0);
        std::size_t const n = layout_.items;
        double const sd = std::exp(x[layout_.sd_at()]), t = layout_.has_ties ? std::exp(x[layout_.tie_at()]) : 0;
        double sum = -0.5 * std::pow(sd / kSdPrior, 2) + x[layout_.sd_at()];
        g[layout_.sd_at()] = 1 - std::pow(sd / kSdPrior, 2);
        for (std::size_t i = 1; i < n; ++i) {
            sum -= 0.5 * std::pow(x[i - 1] / kScorePrior, 2);
            g[i - 1] -= x[i - 1] / (kScorePrior * kScorePrior);
        }
        if (layout_.has_ties) {
            double const z = x[layout_.tie_at()] - std::log(kTiePrior);
            sum -= 0.5 * z * z;
            g[layout_.tie_at()] -= z;
        }
        for (std::size_t o = 0; o < layout_.observers; ++o) {
            std::size_t const own = layout_.own_at(o);
            for (std::size_t i = 0; i < n; ++i) {
                sum -= 0.5 * x[own + i] * x[own + i];
                g[own + i] -= x[own + i];
            }
            for (PairCount const& p : pairs_[o]) {
                auto const i = std::size_t(p.first), j = std::size_t(p.second);
                double const d = score_at(x, i) - score_at(x, j) + sd * (x[own + i] - x[own + j]);
                double by_d = 0, by_t = 0;
                sum += log_choices(p, d, t, by_d, by_t);
                if (i > 0) g[i - 1] += by_d;
                if (j > 0) g[j - 1] -= by_d;
                g[own + i] += sd * by_d;
                g[own + j] -= sd * by_d;
                g[layout_.sd_at()] += by_d * sd * (x[own + i] - x[own + j]);
                if (layout_.has_ties) g[layout_.tie_at()] += by_t * t;
            }
        }
        return sum;
    }

private:
    static double log_choices(PairCount const& p, double d, double t, double& by_d, double& by_t)
    {
        double const a = d - t, b = -d - t;
        double const log_a = p.first_wins > 0 ? log_normal_cdf(a) : 0;
        double const log_b = p.second_wins > 0 ? log_normal_cdf(b) : 0;
        double const up = p.first_wins > 0 ? p.first_wins * hazard(a, log_a) : 0;
        double const down = p.second_wins > 0 ? p.second_wins * hazard(b, log_b) : 0;
        by_d = up - down;
        by_t = -up - down;
        double sum = p.first_wins * log_a + p.second_wins * log_b;
        if (p.ties > 0 && t > 0) {
            // P(tie) = Phi(t - d) - Phi(-t - d); by its smaller tail.
            double const s = std::abs(d), high = t - s, low = -t - s;
            double const tie = std::max(1e-300, normal_cdf(high) - normal_cdf(low));
            sum += p.ties * std::log(tie);
            double const f_high = normal_pdf(high), f_low = normal_pdf(low);
            by_t += p.ties * (f_high + f_low) / tie;
            by_d += p.ties * (d < 0 ? 1 : -1) * (f_high - f_low) / tie;
        }
        return sum;
    }

    HierarchyLayout layout_;
    std::vector<std::vector<PairCount>> pairs_;
};

/// Scores and how observers differ in them, with their diagnostics.
HierarchicalScale scale_of(Draws const& draws, HierarchyLayout const& layout, double confidence)
{
    HierarchicalScale s;
    s.report = report_of(draws);
    auto const kept = [&](std::function<double(std::span<double const>)> const& quantity) {
        Posterior const p = posterior(draws, quantity, confidence);
        look_at(s.report, p.convergence);
        return p;
    };
    std::size_t const n = layout.items;
    auto const mean_of_scores = [n](std::span<double const> x) {
        double sum = 0;
        for (std::size_t i = 0; i < n; ++i) sum += score_at(x, i);
        return sum / double(n);
    };
    for (std::size_t i = 0; i < n; ++i)
        s.score.push_back(kept([&](std::span<double const> x) { return score_at(x, i) - mean_of_scores(x); }));
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = i + 1; j < n; ++j)
            s.difference.push_back(
                kept([&](std::span<double const> x) { return score_at(x, i) - score_at(x, j); }));
    s.between_sd = kept([&](std::span<double const> x) { return std::exp(x[layout.sd_at()]); });
    if (layout.has_ties)
        s.tie_threshold = kept([&](std::span<double const> x) { return std::exp(x[layout.tie_at()]); });
    for (std::size_t o = 0; o < layout.observers; ++o) {
        std::vector<double> own(n, 0);
        for (int c = 0; c < draws.chains; ++c)
            for (int d = 0; d < draws.per_chain; ++d) {
                auto const x = draws.at(c, d);
                double const sd = std::exp(x[layout.sd_at()]);
                for (std::size_t i = 0; i < n; ++i) own[i] += score_at(x, i) + sd * x[layout.own_at(o) + i];
            }
        double sum = 0;
        for (double& v : own) sum += v /= double(draws.chains) * draws.per_chain;
        for (double& v : own) v -= sum / double(n);
        s.observer.push_back(std::move(own));
    }
    s.note = complaint(s.report, draws.chains);
    return s;
}

} // namespace

HierarchicalScale hierarchical_scale(std::vector<std::vector<PairCount>> const& observers, int items,
                                     double confidence, SamplerSettings const& settings)
{
    if (observers.size() < 2 || items < 2)
        refuse("a hierarchical scale of " + std::to_string(observers.size()) + " observers and " +
                   std::to_string(items) + " items",
               "it estimates how observers differ", "use the scale of pooled choices");
    std::vector<PairCount> all;
    std::vector<std::vector<PairCount>> pairs;
    bool has_ties = false;
    for (auto const& o : observers) {
        pairs.push_back(without_order(o));
        all.insert(all.end(), o.begin(), o.end());
        for (PairCount const& p : o) has_ties = has_ties || p.ties > 0;
    }
    std::vector<int> const part = connected_parts(wins_of(all, items));
    if (std::any_of(part.begin(), part.end(), [](int p) { return p != 0; }))
        refuse("items that no chain of comparisons connects", "their distance is unknown",
               "scale the connected items separately");

    HierarchyLayout const layout{std::size_t(items), observers.size(), has_ties};
    std::vector<double> start(layout.count(), 0.0);
    start[layout.sd_at()] = std::log(0.3);
    if (has_ties) start[layout.tie_at()] = std::log(kTiePrior);
    HierarchyDensity const density(layout, std::move(pairs));
    return fit_by_draws(settings, [&](SamplerSettings const& now) {
        return scale_of(sample(density, start, now), layout, confidence);
    });
}

} // namespace study
