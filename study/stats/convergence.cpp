#include "gi/core/quantile.h"
#include "study/numeric/special.h"
#include "study/stats/sampler.h"
#include "study/stats/summary.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <numeric>

namespace study {
namespace {

using Chains = std::vector<std::vector<double>>;

Chains halves(Chains const& chains)
{
    Chains out;
    for (auto const& c : chains) {
        auto const half = std::ptrdiff_t(c.size() / 2);
        out.emplace_back(c.begin(), c.begin() + half);
        out.emplace_back(c.end() - half, c.end());
    }
    return out;
}

/// Normal scores of the ranks among all chains; ties share their mean rank.
Chains rank_normalised(Chains const& chains)
{
    std::vector<std::pair<double, std::size_t>> all;
    for (auto const& c : chains)
        for (double const v : c) all.emplace_back(v, all.size());
    std::sort(all.begin(), all.end());
    std::vector<double> score(all.size());
    for (std::size_t i = 0, j; i < all.size(); i = j) {
        for (j = i; j < all.size() && all[j].first == all[i].first;) ++j;
        double const rank = (double(i + 1) + double(j)) / 2;
        for (std::size_t k = i; k < j; ++k)
            score[all[k].second] = normal_quantile((rank - 0.375) / (double(all.size()) + 0.25));
    }
    Chains out = chains;
    std::size_t next = 0;
    for (auto& c : out)
        for (double& v : c) v = score[next++];
    return out;
}

struct Variances {
    double within = 0, total = 0;
};

Variances variances(Chains const& chains)
{
    auto const n = double(chains.front().size());
    std::vector<double> means;
    Variances v;
    for (auto const& c : chains) {
        means.push_back(mean(c));
        double const s = standard_deviation(c);
        v.within += s * s / double(chains.size());
    }
    double const between = means.size() > 1 ? std::pow(standard_deviation(means), 2) : 0;
    v.total = v.within * (n - 1) / n + between;
    return v;
}

double r_hat(Chains const& chains)
{
    Variances const v = variances(chains);
    return std::sqrt(v.total / v.within);
}

/// Geyer's initial monotone sequence of the autocorrelations of all chains.
double effective(Chains const& chains)
{
    std::size_t const n = chains.front().size();
    Variances const v = variances(chains);
    if (!(v.total > 0)) return std::nan("");
    std::vector<double> means;
    for (auto const& c : chains) means.push_back(mean(c));
    auto const correlation = [&](std::size_t lag) {
        double covariance = 0; // with 1 / n, mean over chains
        for (std::size_t c = 0; c < chains.size(); ++c) {
            double sum = 0;
            for (std::size_t i = 0; i + lag < n; ++i)
                sum += (chains[c][i] - means[c]) * (chains[c][i + lag] - means[c]);
            covariance += sum / double(n) / double(chains.size());
        }
        return 1 - (v.within - covariance) / v.total;
    };
    double sum = 0, smallest = kInfinity, even = 1;
    for (std::size_t lag = 0; lag + 3 < n; lag += 2) {
        double const pair = even + correlation(lag + 1);
        if (!(pair > 0)) break;
        smallest = std::min(smallest, pair);
        sum += smallest;
        even = correlation(lag + 2);
    }
    double const count = double(n) * double(chains.size());
    double const time = std::max(2 * sum - 1 + std::max(0.0, even), 1 / std::log10(count));
    return count / time;
}

} // namespace

Convergence convergence(std::vector<std::vector<double>> const& chains)
{
    double const none = std::nan("");
    bool good = !chains.empty();
    for (auto const& c : chains)
        good = good && c.size() >= 4 && c.size() == chains.front().size() &&
               std::all_of(c.begin(), c.end(), [](double v) { return std::isfinite(v); });
    if (!good) return {none, none, none};
    Chains const split = halves(chains);
    std::vector<double> all;
    for (auto const& c : split) all.insert(all.end(), c.begin(), c.end());
    auto const mapped = [&](auto const& f) {
        Chains out = split;
        for (auto& c : out)
            for (double& v : c) v = f(v);
        return out;
    };
    double const median = gi::quantile(all, 0.5), q05 = gi::quantile(all, 0.05), q95 = gi::quantile(all, 0.95);
    Chains const ranks = rank_normalised(split);
    Chains const folded = rank_normalised(mapped([&](double v) { return std::abs(v - median); }));
    Convergence c;
    c.r_hat = std::max(r_hat(ranks), r_hat(folded));
    c.bulk = effective(ranks);
    c.tail = std::min(effective(mapped([&](double v) { return v <= q05 ? 1.0 : 0.0; })),
                      effective(mapped([&](double v) { return v <= q95 ? 1.0 : 0.0; })));
    return c;
}

Posterior posterior(Draws const& draws, std::function<double(std::span<double const>)> const& quantity,
                    double confidence)
{
    Chains chains;
    std::vector<double> all;
    for (int c = 0; c < draws.chains; ++c) {
        chains.emplace_back();
        for (int i = 0; i < draws.per_chain; ++i) chains.back().push_back(quantity(draws.at(c, i)));
        all.insert(all.end(), chains.back().begin(), chains.back().end());
    }
    double const tail = (1 - confidence) / 2;
    return {mean(all),
            standard_deviation(all),
            gi::quantile(all, tail),
            gi::quantile(all, 0.5),
            gi::quantile(all, 1 - tail),
            convergence(chains)};
}

void look_at(SamplerReport& report, Convergence const& c)
{
    // Chains that never moved have no R-hat.
    bool const first = report.worst_r_hat == 0, is_known = std::isfinite(c.r_hat);
    double const bulk = is_known ? c.bulk : 0, tail = is_known ? c.tail : 0;
    report.worst_r_hat =
        std::max(report.worst_r_hat, is_known ? c.r_hat : std::numeric_limits<double>::infinity());
    report.least_bulk = first ? bulk : std::min(report.least_bulk, bulk);
    report.least_tail = first ? tail : std::min(report.least_tail, tail);
}

SamplerReport report_of(Draws const& draws)
{
    SamplerReport r;
    r.draws = draws.chains * draws.per_chain;
    r.divergences = draws.divergences;
    r.longest_paths = draws.longest_paths;
    r.evaluations = draws.evaluations;
    return r;
}

std::string complaint(SamplerReport const& r, int chains)
{
    std::string text;
    auto const say = [&](bool when, std::string const& what) {
        if (when) text += (text.empty() ? "" : "; ") + what;
    };
    say(!(r.worst_r_hat <= kMostRHat),
        fmt::format("chains differ (R-hat {:.3f}, wanted: {} or less)", r.worst_r_hat, kMostRHat));
    double const least = std::fmin(r.least_bulk, r.least_tail);
    say(!(least >= 100 * chains), fmt::format("{:.0f} effective draws (wanted: {} or more)", least, 100 * chains));
    say(r.divergences > 0, fmt::format("{} of {} draws diverged", r.divergences, r.draws));
    say(10 * r.longest_paths > r.draws,
        fmt::format("{} of {} paths were cut at their greatest length", r.longest_paths, r.draws));
    return text;
}

} // namespace study
