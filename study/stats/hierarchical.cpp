#include "study/stats/hierarchical.h"

#include "study/numeric/error.h"
#include "study/numeric/special.h"
#include "study/stats/curve_likelihood.h"

#include <algorithm>
#include <cmath>

namespace study {
namespace {

/// Mean, log of the standard deviation, and standard normal numbers of observers, in a vector of all parameters.
struct RandomEffect {
    std::size_t population = 0;                 ///< index of the mean; the log deviation follows
    std::size_t first = 0;                      ///< of the observers' numbers
    double prior_mean = 0, prior_deviation = 1; ///< of the mean
    double prior_spread = 1;                    ///< half-normal, of the standard deviation
    std::vector<double> variances{};            ///< of observers' own estimates, for the reference prior; or none

    double deviation(std::span<double const> x) const { return std::exp(x[population + 1]); }
    double of(std::span<double const> x, std::size_t i) const
    {
        return x[population] + deviation(x) * x[first + i];
    }
    /// Gradient of an observer's log-likelihood by the effect's value, passed on to the parameters.
    void pass(std::span<double const> x, std::size_t i, double slope, std::span<double> g) const
    {
        double const sd = deviation(x);
        g[population] += slope;
        g[population + 1] += slope * sd * x[first + i];
        g[first + i] += slope * sd;
    }
    double log_prior(std::span<double const> x, std::size_t observers, std::span<double> g) const
    {
        double const z = (x[population] - prior_mean) / prior_deviation, sd = deviation(x), s = sd / prior_spread;
        g[population] -= z / prior_deviation;
        g[population + 1] += 1 - s * s;
        double sum = -0.5 * z * z - 0.5 * s * s + x[population + 1];
        double squares = 0, slopes = 0;
        for (double const v : variances) {
            double const total = sd * sd + v, square = std::pow(sd / total, 2);
            squares += square;
            slopes += square * (v - sd * sd) / total;
        }
        if (!variances.empty()) {
            sum += 0.5 * std::log(squares);
            g[population + 1] += slopes / squares;
        }
        for (std::size_t i = first; i < first + observers; ++i) {
            sum -= 0.5 * x[i] * x[i];
            g[i] -= x[i];
        }
        return sum;
    }
};

/// The variance of an observer's own estimate, bounded where answers have no information, as around d' = 0.
double own_variance(double information) { return 1 / (std::fmax(information, 0) + 1); }

/// Population and observers from the draws, with their diagnostics.
Hierarchical summed_up(Draws const& draws, RandomEffect const& e, std::size_t observers, double confidence,
                       std::function<double(double)> const& to_unit, double unit)
{
    Hierarchical h;
    h.report = report_of(draws);
    auto const look = [&](auto const& quantity) {
        Posterior const p = posterior(draws, quantity, confidence);
        look_at(h.report, p.convergence);
        return p;
    };
    h.mean = look([&](std::span<double const> x) { return to_unit(x[e.population]); });
    h.deviation = look([&](std::span<double const> x) { return unit * e.deviation(x); });
    for (std::size_t i = 0; i < observers; ++i)
        h.observer.push_back(look([&](std::span<double const> x) { return to_unit(e.of(x, i)); }));
    h.note = complaint(h.report, draws.chains);
    return h;
}

} // namespace

Hierarchical hierarchical_dprime(DetectionTask task, std::span<DetectionCounts const> all, double confidence,
                                 SamplerSettings const& sampler)
{
    std::vector<DetectionCounts> people;
    for (DetectionCounts const& c : all)
        if (c.signals + c.noises > 0) people.push_back(c);
    if (people.empty())
        refuse("d' of observers without trials", "nothing was answered", "leave the condition out");
    std::size_t const n = people.size();
    bool const two = has_criterion(task);
    double mean = 0, criteria = 0;
    for (DetectionCounts const& k : people) {
        DetectionPoint const p = detection_point(task, k);
        mean += p.dprime / double(n);
        criteria += p.criterion / double(n);
    }
    RandomEffect d{0, two ? 4u : 2u, 0, 2, 2}, c{2, 4 + n, 0, 2, 1};
    for (DetectionCounts const& k : people) {
        auto const [dd, dc, cc] = detection_likelihood(task, k, mean, criteria).information;
        d.variances.push_back(own_variance(two ? dd - dc * dc / cc : dd));
    }
    auto const density = [&](std::span<double const> x, std::span<double> g) {
        std::fill(g.begin(), g.end(), 0.0);
        double value = d.log_prior(x, n, g) + (two ? c.log_prior(x, n, g) : 0);
        for (std::size_t i = 0; i < n; ++i) {
            DetectionLikelihood const l = detection_likelihood(task, people[i], d.of(x, i), two ? c.of(x, i) : 0);
            value += l.value;
            d.pass(x, i, l.by_dprime, g);
            if (two) c.pass(x, i, l.by_criterion, g);
        }
        return value;
    };
    std::vector<double> start((two ? 4 : 2) + (two ? 2 : 1) * n, 0.0);
    start[0] = mean;
    start[1] = -1;
    if (two) {
        start[2] = criteria;
        start[3] = -1;
    }
    return fit_by_draws(sampler, [&](SamplerSettings const& settings) {
        return summed_up(
            sample(density, start, settings), d, n, confidence, [](double v) { return v; }, 1);
    });
}

Hierarchical hierarchical_psychometric(std::span<ObserverLevels const> observers, GroupThresholdSettings const& s,
                                       SamplerSettings const& sampler)
{
    // The checks of the data, and where the chains start.
    GroupThreshold const group = group_threshold_mode(observers, s);
    double const a = transformed(s.shape, s.low), b = transformed(s.shape, s.high);
    double const range = std::abs(b - a), centre = (a + b) / 2;
    std::vector<std::vector<LevelAnswers>> people;
    std::vector<double> guess;
    bool is_repeated = false;
    for (ObserverLevels const& o : observers) {
        std::vector<LevelAnswers> levels;
        for (LevelCount const& l : o.counts)
            if (l.trials > 0) {
                levels.push_back({(transformed(s.shape, l.level) - centre) / range, l.correct, l.trials});
                is_repeated = is_repeated || l.trials >= 2;
            }
        if (levels.empty()) continue;
        people.push_back(std::move(levels));
        guess.push_back(o.guess);
    }
    is_repeated = is_repeated && group.eta > 0;
    std::size_t const n = people.size(), shared = is_repeated ? 7 : 6;
    RandomEffect threshold{0, shared, 0, 1, 1};
    RandomEffect const scale{2, shared + n, std::log(0.125), 1, 0.5}, lapse{4, shared + 2 * n, -1.7, 1, 0.5};
    double const mean = (group.mean - centre) / range;
    for (std::size_t i = 0; i < n; ++i) {
        auto const curve = level_curve(s.shape.sigmoid, s.proportion, group.shared.scale / range,
                                       group.shared.lapse, guess[i], group.eta);
        threshold.variances.push_back(
            own_variance(curve ? level_likelihood(people[i], *curve, mean, false).information : 0));
    }
    // So that every curve reaches the proportion.
    double const most_lapses = std::min(0.2, 0.9 * (1 - s.proportion));
    auto const density = [&](std::span<double const> x, std::span<double> g) -> double {
        std::fill(g.begin(), g.end(), 0.0);
        double sum = threshold.log_prior(x, n, g) + scale.log_prior(x, n, g) + lapse.log_prior(x, n, g);
        double const eta = is_repeated ? inverse_logit(x[6]) : 0;
        if (is_repeated) {
            sum += std::log(eta) + 10 * std::log1p(-eta);
            g[6] += 1 - 11 * eta;
        }
        for (std::size_t i = 0; i < n; ++i) {
            double const share = inverse_logit(lapse.of(x, i)), lapses = s.lapse.value_or(most_lapses * share);
            auto const curve =
                level_curve(s.shape.sigmoid, s.proportion, std::exp(scale.of(x, i)), lapses, guess[i], eta);
            if (!curve) return -INFINITY;
            LevelLikelihood const l = level_likelihood(people[i], *curve, threshold.of(x, i), true);
            sum += l.value;
            threshold.pass(x, i, l.by_threshold, g);
            scale.pass(x, i, l.by_log_scale, g);
            if (!s.lapse) lapse.pass(x, i, l.by_lapse * lapses * (1 - share), g);
            if (is_repeated) g[6] += l.by_nu * nu_by_logit(eta);
        }
        return sum;
    };
    std::vector<double> start(shared + 3 * n, 0.0);
    start[0] = mean;
    start[1] = std::log(std::max(0.03, group.deviation / range));
    start[2] = std::log(group.shared.scale / range);
    start[3] = -2;
    start[4] = -1.7;
    start[5] = -1.5;
    if (is_repeated) start[6] = -2.5;
    return fit_by_draws(sampler, [&](SamplerSettings const& settings) {
        Draws const draws = sample(density, start, settings);
        Hierarchical h = summed_up(
            draws, threshold, n, s.confidence, [&](double v) { return centre + range * v; }, range);
        auto const at = [&](auto const& f) { return posterior(draws, f, s.confidence); };
        h.scale = at([&](std::span<double const> x) { return range * std::exp(x[2]); });
        h.lapse =
            at([&](std::span<double const> x) { return s.lapse.value_or(most_lapses * inverse_logit(x[4])); });
        look_at(h.report, h.scale.convergence);
        if (!s.lapse) look_at(h.report, h.lapse.convergence);
        h.note = complaint(h.report, draws.chains);
        return h;
    });
}

} // namespace study
