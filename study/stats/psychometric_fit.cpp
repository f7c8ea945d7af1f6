#include "study/stats/psychometric_fit.h"

#include "study/adaptive/sigmoid.h"
#include "study/numeric/error.h"
#include "study/stats/formula_fit.h"
#include "study/stats/likelihood.h"
#include "study/stats/step_gap.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <map>

namespace study {
namespace {

/// A level on the axis of u.
struct Point {
    double u, correct, trials;
};

/// Fitted parameters: threshold and log scale always, guess and lapse if their Rate requires it.
struct Model {
    Sigmoid kind;
    Rate guess, lapse;
    std::vector<Point> points;
    double centre = 0, range = 1; ///< of u; thresholds are fitted in units of this range from the centre

    bool fits_guess() const { return guess.limit > 0; }
    bool fits_lapse() const { return lapse.limit > 0; }
    std::size_t count() const { return 2 + std::size_t(fits_guess()) + std::size_t(fits_lapse()); }

    PsychometricParameters parameters(std::span<double const> x) const
    {
        return {centre + x[0] * range, std::exp(x[1]) * range, fits_guess() ? x[2] : guess.value,
                fits_lapse() ? x[count() - 1] : lapse.value};
    }

    void evaluate(std::span<double const> x, Likelihood& l) const
    {
        l.clear(count());
        PsychometricParameters const p = parameters(x);
        double const span = 1 - p.guess - p.lapse;
        for (Point const& point : points) {
            double const z = (point.u - p.threshold) / p.scale;
            SigmoidValue const f = sigmoid(kind, z);
            double const right = std::max(1e-300, p.guess + span * f.below);
            double const wrong = std::max(1e-300, p.lapse + span * f.above);
            double const missed = point.trials - point.correct;
            if (point.correct > 0) l.log_likelihood += point.correct * std::log(right);
            if (missed > 0) l.log_likelihood += missed * std::log(wrong);

            std::array<double, 4> slope{-span * f.density * range / p.scale, -span * f.density * z};
            if (fits_guess()) slope[2] = f.above;
            if (fits_lapse()) slope[count() - 1] = -f.below;
            double const pull = point.correct / right - missed / wrong;
            double const weight = point.trials / (right * wrong);
            for (std::size_t a = 0; a < count(); ++a) {
                l.gradient[a] += pull * slope[a];
                for (std::size_t b = 0; b < count(); ++b) l.information(a, b) += weight * slope[a] * slope[b];
            }
        }
    }

    std::vector<Bound> bounds() const
    {
        std::vector<Bound> b{{-5, 5}, {std::log(1e-4), std::log(1e3)}};
        if (fits_guess()) b.push_back({0, guess.limit});
        if (fits_lapse()) b.push_back({0, lapse.limit});
        return b;
    }
};

std::vector<Point> checked_points(std::span<LevelCount const> counts, PsychometricShape const& shape)
{
    std::map<double, Point> points;
    for (LevelCount const& c : counts) {
        if (!(c.correct >= 0 && c.correct <= c.trials && std::isfinite(c.trials)))
            refuse(fmt::format("{:g} of {:g} trials", c.correct, c.trials),
                   "counts are numbers, with no more correct responses than trials", "check the table");
        if (!std::isfinite(c.level) || (shape.axis == Axis::log10 && !(c.level > 0)))
            refuse(fmt::format("level {:.9g}", c.level), "it has no place on the axis",
                   shape.axis == Axis::log10 ? "use levels above 0, or a linear axis" : "use numbers");
        if (c.trials == 0) continue;
        Point& p = points[transformed(shape, c.level)];
        p.u = transformed(shape, c.level);
        p.correct += c.correct;
        p.trials += c.trials;
    }
    if (points.size() < 2)
        refuse("trials at " + std::to_string(points.size()) + " levels", "a curve needs two or more",
               "show more levels, or report a proportion");
    std::vector<Point> result;
    for (auto const& [unused, p] : points) result.push_back(p);
    return result;
}

Model make_model(std::span<LevelCount const> counts, PsychometricSettings const& settings)
{
    Model m{settings.shape.sigmoid, settings.guess, settings.lapse, checked_points(counts, settings.shape)};
    double const guess = std::max(m.guess.value, m.guess.limit), lapse = std::max(m.lapse.value, m.lapse.limit);
    if (!(m.guess.value >= 0 && m.lapse.value >= 0 && m.guess.limit >= 0 && m.lapse.limit >= 0 &&
          guess + lapse < 1))
        refuse("guess rate up to " + std::to_string(guess) + " and lapse rate up to " + std::to_string(lapse),
               "together they leave no room for a curve", "use rates from 0 whose sum is below 1");
    m.range = m.points.back().u - m.points.front().u;
    m.centre = (m.points.back().u + m.points.front().u) / 2;
    return m;
}

/// The best fit from the most likely points of a grid.
MaximumLikelihood best_fit(Model const& m)
{
    LikelihoodAt const at = [&](std::span<double const> x, Likelihood& l) { m.evaluate(x, l); };
    std::multimap<double, std::vector<double>> starts;
    Likelihood l;
    for (double threshold = -0.75; threshold <= 0.75; threshold += 0.125)
        for (double scale : {0.01, 0.04, 0.1, 0.25, 0.6, 2.0}) {
            std::vector<double> x{threshold, std::log(scale)};
            if (m.fits_guess()) x.push_back(std::clamp(m.guess.value, m.guess.limit * 0.02, m.guess.limit * 0.98));
            if (m.fits_lapse()) x.push_back(std::clamp(m.lapse.value, m.lapse.limit * 0.02, m.lapse.limit * 0.98));
            at(x, l);
            starts.emplace(-l.log_likelihood, x);
        }
    MaximumLikelihood best;
    int tried = 0;
    for (auto const& [unused, x] : starts) {
        MaximumLikelihood const fit = maximise(at, x, m.bounds(), 800);
        if (tried == 0 || fit.log_likelihood > best.log_likelihood) best = fit;
        if (++tried == 3) break;
    }
    return best;
}

std::string note_of(Model const& m, MaximumLikelihood const& fit, std::optional<StepGap> const& gap)
{
    std::string note;
    auto const say = [&](bool when, char const* what) {
        if (when) note += std::string(note.empty() ? "" : "; ") + what;
    };
    bool const none = std::all_of(m.points.begin(), m.points.end(), [](Point const& p) { return p.correct == 0; });
    bool const all =
        std::all_of(m.points.begin(), m.points.end(), [](Point const& p) { return p.correct == p.trials; });
    say(none, "no correct response at all: there is no threshold among these levels");
    say(all, "nothing but correct responses: there is no threshold among these levels");
    Trend trend;
    for (Point const& p : m.points) trend.add(p.u, p.correct, p.trials);
    say(trend.is_falling(), kWrongDirection);
    say(fit.at_bound[0], "the threshold lies far outside the levels shown");
    if (gap) say(true, text_of(*gap).c_str());
    // Below a hundredth of the range the curve is a step between two levels.
    say(!gap && (fit.estimate[1] < std::log(0.01) || std::isnan(fit.covariance(0, 0))),
        "responses change within one step of level: threshold and scale are known only to lie between levels");
    say(fit.estimate[1] > std::log(20.0), "responses hardly change with level: the scale cannot be estimated");
    say(m.fits_guess() && fit.estimate[2] >= m.guess.limit, "the guess rate is at its limit");
    say(m.fits_lapse() && fit.estimate[m.count() - 1] >= m.lapse.limit, "the lapse rate is at its limit");
    say(!fit.converged, "the fit did not converge");
    return note;
}

PsychometricFit describe(Model const& m, PsychometricShape const& shape, MaximumLikelihood const& best,
                         std::optional<StepGap> const& gap)
{
    PsychometricFit fit;
    fit.shape = shape;
    fit.parameters = m.parameters(best.estimate);
    std::array<double, 4> const unit{m.range, 1, 1, 1};
    std::array<int, 4> const index{0, 1, m.fits_guess() ? 2 : -1, m.fits_lapse() ? int(m.count()) - 1 : -1};
    fit.covariance = Matrix(4, 4);
    for (std::size_t a = 0; a < 4; ++a)
        for (std::size_t b = 0; b < 4; ++b)
            if (index[a] >= 0 && index[b] >= 0)
                fit.covariance(a, b) =
                    best.covariance(std::size_t(index[a]), std::size_t(index[b])) * unit[a] * unit[b];
    auto const error = [&](std::size_t i) { return std::sqrt(fit.covariance(i, i)); };
    fit.standard_error = {error(0), error(1) * fit.parameters.scale, error(2), error(3)};
    fit.converged = best.converged;
    fit.note = note_of(m, best, gap);

    double saturated = 0, constant = 0;
    for (Point const& p : m.points) {
        if (p.correct > 0) saturated += p.correct * std::log(p.correct / p.trials);
        if (p.correct < p.trials) saturated += (p.trials - p.correct) * std::log1p(-p.correct / p.trials);
        constant += log_choose(p.trials, p.correct);
    }
    fit.log_likelihood = best.log_likelihood + constant;
    fit.deviance = std::max(0.0, 2 * (saturated - best.log_likelihood));
    fit.degrees_of_freedom = int(m.points.size()) - int(m.count());
    if (fit.degrees_of_freedom > 0) fit.fit_p = chi_square_tail(fit.deviance, fit.degrees_of_freedom);
    return fit;
}

} // namespace

PsychometricFit fit_psychometric(std::span<LevelCount const> counts, PsychometricSettings const& settings)
{
    if (settings.shape.formula) return fit_formula(counts, settings);
    Model const m = make_model(counts, settings);
    StepRates rates;
    if (!m.fits_guess()) rates.guess = m.guess.value;
    if (!m.fits_lapse()) rates.lapse = m.lapse.value;
    return describe(m, settings.shape, best_fit(m), step_gap(counts, settings.shape, rates));
}

double standard_error_at(PsychometricFit const& fit, double proportion)
{
    auto const moved = [&](std::size_t i, double by) {
        PsychometricParameters p = fit.parameters;
        if (i == 0) p.threshold += by;
        if (i == 1) p.scale *= std::exp(by);
        if (i == 2) p.guess += by;
        if (i == 3) p.lapse += by;
        return transformed(fit.shape, level_at(fit.shape, p, proportion));
    };
    std::array<double, 4> slope{};
    for (std::size_t i = 0; i < 4; ++i) {
        if (fit.covariance(i, i) == 0) continue;
        double const step = 1e-3 * std::sqrt(fit.covariance(i, i));
        slope[i] = (moved(i, step) - moved(i, -step)) / (2 * step);
    }
    double variance = 0;
    for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = 0; j < 4; ++j) variance += slope[i] * fit.covariance(i, j) * slope[j];
    return std::sqrt(variance);
}

void Trend::add(double u, double n_correct, double n)
{
    if (own_.trials == 0) own_.first = u;
    double const away = u - own_.first; // 0 if there is one level, whatever is rounded
    own_.trials += n;
    own_.correct += n_correct;
    own_.u += n * away;
    own_.square += n * away * away;
    own_.product += n_correct * away;
}

void Trend::next_observer()
{
    finish(covariance_, variance_);
    own_ = {};
}

void Trend::finish(double& covariance, double& variance) const
{
    if (own_.trials == 0) return;
    double const p = own_.correct / own_.trials;
    covariance += own_.product - p * own_.u;
    variance += p * (1 - p) * std::max(0.0, own_.square - own_.u * own_.u / own_.trials);
}

bool Trend::is_falling() const
{
    double covariance = covariance_, variance = variance_;
    finish(covariance, variance);
    return covariance < -2 * std::sqrt(variance);
}

std::vector<LevelCount> count_levels(std::span<double const> levels, std::span<int const> correct)
{
    if (levels.size() != correct.size())
        refuse(std::to_string(levels.size()) + " levels and " + std::to_string(correct.size()) + " responses",
               "each trial has one of both", "give lists of the same length");
    std::map<double, LevelCount> counts;
    for (std::size_t i = 0; i < levels.size(); ++i) {
        if (std::isnan(levels[i]))
            refuse("a level that is not a number", "it has no place on the axis", "leave it out");
        LevelCount& c = counts[levels[i]];
        c.level = levels[i];
        c.correct += correct[i] != 0;
        c.trials += 1;
    }
    std::vector<LevelCount> result;
    for (auto const& [unused, c] : counts) result.push_back(c);
    return result;
}

} // namespace study
