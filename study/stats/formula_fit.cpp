#include "study/stats/formula_fit.h"

#include "study/numeric/error.h"
#include "study/numeric/special.h"
#include "study/stats/likelihood.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <map>

namespace study {
namespace {

constexpr double kLeast = 1e-9; ///< proportions nearer to 0 or 1 count as this

/// Parameters: threshold on u, log slope, then guess and lapse if they are fitted.
struct FormulaModel {
    PsychometricShape const& shape;
    Rate guess, lapse;
    std::map<double, LevelCount> counts;

    std::size_t size() const { return 2 + std::size_t(guess.limit > 0) + std::size_t(lapse.limit > 0); }
    PsychometricParameters parameters(std::span<double const> x) const
    {
        return {x[0], std::exp(x[1]), guess.limit > 0 ? x[2] : guess.value,
                lapse.limit > 0 ? x[size() - 1] : lapse.value};
    }
    double at(std::span<double const> x, double level) const
    {
        return std::clamp(proportion_at(shape, parameters(x), level), kLeast, 1 - kLeast);
    }
    double slope_at(std::span<double const> x, double level, std::size_t i) const
    {
        double const h = 1e-5 * std::max(1e-2, std::abs(x[i]));
        std::vector<double> lower(x.begin(), x.end()), upper = lower;
        lower[i] -= h;
        upper[i] += h;
        return (at(upper, level) - at(lower, level)) / (2 * h);
    }
    void evaluate(std::span<double const> x, Likelihood& l) const
    {
        l.clear(size());
        std::vector<double> slope(size());
        for (auto const& [level, c] : counts) {
            double const p = at(x, level);
            if (!std::isfinite(p)) {
                l.log_likelihood = -kInfinity;
                return;
            }
            l.log_likelihood += c.correct * std::log(p) + (c.trials - c.correct) * std::log1p(-p);
            for (std::size_t i = 0; i < size(); ++i) slope[i] = slope_at(x, level, i);
            for (std::size_t i = 0; i < size(); ++i) {
                l.gradient[i] += (c.correct / p - (c.trials - c.correct) / (1 - p)) * slope[i];
                for (std::size_t j = 0; j < size(); ++j)
                    l.information(i, j) += c.trials / (p * (1 - p)) * slope[i] * slope[j];
            }
        }
    }
};

FormulaModel formula_model(std::span<LevelCount const> counts, PsychometricSettings const& s)
{
    FormulaModel m{s.shape, s.guess, s.lapse, {}};
    for (LevelCount const& c : counts) {
        if (!(c.correct >= 0 && c.correct <= c.trials && std::isfinite(c.trials)))
            refuse(fmt::format("{:g} of {:g} trials", c.correct, c.trials),
                   "counts are numbers, with no more correct responses than trials", "check the table");
        if (!std::isfinite(transformed(s.shape, c.level)))
            refuse(fmt::format("level {:.9g}", c.level), "it has no place on the axis", "use other levels");
        if (c.trials == 0) continue;
        LevelCount& sum = m.counts[c.level];
        sum = {c.level, sum.correct + c.correct, sum.trials + c.trials};
    }
    if (m.counts.size() < 2)
        refuse("trials at " + std::to_string(m.counts.size()) + " levels", "a curve needs two or more",
               "show more levels, or report a proportion");
    return m;
}

MaximumLikelihood best_formula_fit(FormulaModel const& m, double low, double high)
{
    std::vector<Bound> bounds{{low - (high - low), high + (high - low)}, {std::log(1e-3), std::log(1e3)}};
    if (m.guess.limit > 0) bounds.push_back({0, m.guess.limit});
    if (m.lapse.limit > 0) bounds.push_back({0, m.lapse.limit});
    LikelihoodAt const at = [&](std::span<double const> x, Likelihood& l) { m.evaluate(x, l); };
    std::multimap<double, std::vector<double>> starts;
    Likelihood l;
    for (double share = -0.25; share <= 1.25; share += 0.125)
        for (double log_slope = -6; log_slope <= 6; log_slope += 0.75) {
            std::vector<double> x{low + share * (high - low), log_slope};
            if (m.guess.limit > 0)
                x.push_back(std::clamp(m.guess.value, 0.02 * m.guess.limit, 0.98 * m.guess.limit));
            if (m.lapse.limit > 0)
                x.push_back(std::clamp(m.lapse.value, 0.02 * m.lapse.limit, 0.98 * m.lapse.limit));
            at(x, l);
            if (std::isfinite(l.log_likelihood)) starts.emplace(-l.log_likelihood, x);
        }
    if (starts.empty())
        refuse("the formula gives no proportion at these levels", "it is infinite or not a number everywhere",
               "correct the formula");
    MaximumLikelihood best;
    int tried = 0;
    for (auto const& [unused, x] : starts) {
        MaximumLikelihood const fit = maximise(at, x, bounds);
        if (tried == 0 || fit.log_likelihood > best.log_likelihood) best = fit;
        if (++tried == 3) break;
    }
    return best;
}

} // namespace

PsychometricFit fit_formula(std::span<LevelCount const> counts, PsychometricSettings const& settings)
{
    FormulaModel const m = formula_model(counts, settings);
    double low = kInfinity, high = -kInfinity, saturated = 0, constant = 0;
    bool none = true, all = true;
    for (auto const& [level, c] : m.counts) {
        double const u = transformed(settings.shape, level);
        low = std::min(low, u);
        high = std::max(high, u);
        none = none && c.correct == 0;
        all = all && c.correct == c.trials;
        if (c.correct > 0) saturated += c.correct * std::log(c.correct / c.trials);
        if (c.correct < c.trials) saturated += (c.trials - c.correct) * std::log1p(-c.correct / c.trials);
        constant += log_choose(c.trials, c.correct);
    }
    MaximumLikelihood const best = best_formula_fit(m, low, high);
    PsychometricFit fit;
    fit.shape = settings.shape;
    fit.parameters = m.parameters(best.estimate);
    std::array<int, 4> const index{0, 1, m.guess.limit > 0 ? 2 : -1, m.lapse.limit > 0 ? int(m.size()) - 1 : -1};
    fit.covariance = Matrix(4, 4);
    for (std::size_t a = 0; a < 4; ++a)
        for (std::size_t b = 0; b < 4; ++b)
            if (index[a] >= 0 && index[b] >= 0)
                fit.covariance(a, b) = best.covariance(std::size_t(index[a]), std::size_t(index[b]));
    auto const error = [&](std::size_t i) { return std::sqrt(fit.covariance(i, i)); };
    fit.standard_error = {error(0), error(1) * fit.parameters.scale, error(2), error(3)};
    fit.converged = best.converged;
    fit.log_likelihood = best.log_likelihood + constant;
    fit.deviance = std::max(0.0, 2 * (saturated - best.log_likelihood));
    fit.degrees_of_freedom = int(m.counts.size()) - int(m.size());
    if (fit.degrees_of_freedom > 0) fit.fit_p = chi_square_tail(fit.deviance, fit.degrees_of_freedom);
    if (none || all)
        fit.note = std::string(none ? "no correct response at all" : "nothing but correct responses") +
                   ": there is no threshold among these levels";
    else if (best.at_bound[0] || best.at_bound[1])
        fit.note = "the threshold or the slope of the formula is at the limit of the search";
    return fit;
}

} // namespace study
