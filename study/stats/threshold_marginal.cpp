#include "study/stats/threshold_marginal.h"

#include "study/numeric/error.h"
#include "study/stats/gauss_hermite.h"

#include <fmt/format.h>

namespace study {
namespace {

/// Beta-binomial distributions are of whole numbers; counts from percentages are none.
bool has_whole_counts(std::span<ObserverLevels const> observers)
{
    return std::all_of(observers.begin(), observers.end(), [](ObserverLevels const& o) {
        return std::all_of(o.counts.begin(), o.counts.end(), [](LevelCount const& c) {
            return c.correct == std::floor(c.correct) && c.trials == std::floor(c.trials);
        });
    });
}

} // namespace

ThresholdMarginal::ThresholdMarginal(std::span<ObserverLevels const> observers, GroupThresholdSettings const& s)
    : s_(s)
{
    double const a = transformed(s.shape, s.low), b = transformed(s.shape, s.high);
    range_ = std::abs(b - a);
    centre_ = (a + b) / 2;
    if (s.low == s.high)
        refuse(fmt::format("trials at one level, {:.9g}", s.low), "a threshold is searched between two levels",
               "show more levels, or report the proportion");
    if (!(range_ > 0 && std::isfinite(range_)))
        refuse(fmt::format("thresholds between {:.9g} and {:.9g}", s.low, s.high),
               "they are expected between two levels", "give two different ones, above 0 on a log scale");
    for (ObserverLevels const& o : observers) add(o);
    is_repeated_ = is_repeated_ && has_whole_counts(observers);
    if (people_.empty())
        refuse("thresholds of observers without trials", "nothing was answered", "leave the condition out");
}

double ThresholdMarginal::operator()(Thresholds const& at, Thresholds& gradient)
{
    gradient.fill(0);
    double sum = 0;
    for (ThresholdPerson& p : people_) {
        p.score.fill(0);
        auto const curve = curve_of(at, s_.fits_guess ? inverse_logit(at[kGuess]) : p.guess);
        if (!curve) return -kInfinity;
        sum += integrate(p, at, *curve);
        for (std::size_t i = 0; i < kCount; ++i) gradient[i] += p.score[i];
    }
    double const lapse = lapse_of(at), eta = inverse_logit(at[kEta]), from_usual = at[kScale] - std::log(0.125);
    sum -= 0.5 * from_usual * from_usual;
    if (!s_.lapse) {
        sum += std::log(lapse) + 20 * std::log1p(-lapse);
        gradient[kLapse] += 1 - 21 * lapse;
    }
    gradient[kScale] -= from_usual;
    if (is_repeated_) {
        sum += std::log(eta) + 2 * std::log1p(-eta); // weaker than for one observer: there are many levels
        gradient[kEta] += 1 - 3 * eta;
    }
    return sum;
}

void ThresholdMarginal::add(ObserverLevels const& o)
{
    ThresholdPerson p;
    p.guess = o.guess;
    if (!(o.guess >= 0 && o.guess < 1))
        refuse("a guess rate of " + std::to_string(o.guess), "it is a proportion below 1", "check it");
    for (LevelCount const& c : o.counts) {
        double const u = transformed(s_.shape, c.level);
        if (!(c.correct >= 0 && c.correct <= c.trials && std::isfinite(c.trials)) || !std::isfinite(u))
            refuse(std::to_string(c.correct) + " of " + std::to_string(c.trials) + " trials at level " +
                       std::to_string(c.level),
                   "counts are numbers, with no more correct responses than trials, at levels on the axis",
                   "check the table");
        if (c.trials > 0) p.levels.push_back({(u - centre_) / range_, c.correct, c.trials});
        is_repeated_ = is_repeated_ || c.trials >= 2;
    }
    if (!p.levels.empty()) people_.push_back(std::move(p));
}

std::optional<LevelCurve> ThresholdMarginal::curve_of(Thresholds const& at, double guess) const
{
    return level_curve(s_.shape.sigmoid, s_.proportion, std::exp(at[kScale]), lapse_of(at), guess,
                       is_repeated_ ? inverse_logit(at[kEta]) : 0);
}

double ThresholdMarginal::integrate(ThresholdPerson& p, Thresholds const& at, LevelCurve const& c) const
{
    static auto const nodes = gauss_hermite(9);
    double const mean = at[kMean], sd = spread_of(at[kSpread]), precision = 1 / (sd * sd);
    auto const joint = [&](double t, LevelLikelihood const& s) {
        return s.value - 0.5 * (t - mean) * (t - mean) * precision;
    };
    // The mode, by scoring from the last one.
    double t = p.mode;
    LevelLikelihood s = level_likelihood(p.levels, c, t, false);
    double here = joint(t, s);
    for (int i = 0; i < 30; ++i) {
        double const pull = s.by_threshold - (t - mean) * precision, curvature = s.information + precision;
        double step = pull / curvature;
        if (pull * step < 1e-9) break;
        bool gained = false;
        for (; std::abs(step) > 1e-7 && !gained; step /= 2) {
            LevelLikelihood const there = level_likelihood(p.levels, c, t + step, false);
            double const value = joint(t + step, there);
            gained = value > here;
            if (!gained) continue;
            t += step;
            s = there;
            here = value;
        }
        if (!gained) break;
    }
    p.mode = t;
    p.information = s.information;
    p.surprises = s.surprises;
    double const width = 1 / std::sqrt(s.information + precision);
    std::array<LevelLikelihood, 9> at_node;
    std::array<double, 9> place, log_value;
    double most = -kInfinity;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        place[i] = t + std::sqrt(2.0) * width * nodes[i].x;
        at_node[i] = level_likelihood(p.levels, c, place[i], true);
        log_value[i] = joint(place[i], at_node[i]) + nodes[i].log_weight;
        most = std::max(most, log_value[i]);
    }
    double sum = 0, m1 = 0, m2 = 0;
    LevelLikelihood average;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        double const w = std::exp(log_value[i] - most), away = place[i] - mean;
        sum += w;
        m1 += w * away;
        m2 += w * away * away;
        average.by_log_scale += w * at_node[i].by_log_scale;
        average.by_lapse += w * at_node[i].by_lapse;
        average.by_guess += w * at_node[i].by_guess;
        average.by_nu += w * at_node[i].by_nu;
    }
    m1 /= sum;
    m2 /= sum;
    p.mean = mean + m1;
    p.score[kMean] = m1 * precision;
    p.score[kSpread] = (m2 * precision - 1) * (1 - kLeastThresholdSd / sd);
    p.score[kScale] = average.by_log_scale / sum;
    p.score[kLapse] = average.by_lapse / sum * c.lapse * (1 - c.lapse);
    if (s_.fits_guess) p.score[kGuess] = average.by_guess / sum * c.guess * (1 - c.guess);
    if (is_repeated_) p.score[kEta] = average.by_nu / sum * nu_by_logit(inverse_logit(at[kEta]));
    return most + std::log(sum) + std::log(width / sd);
}

} // namespace study
