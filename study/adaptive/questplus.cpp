#include "study/adaptive/questplus.h"

#include "study/adaptive/grid_posterior.h"
#include "study/adaptive/sigmoid.h"
#include "study/numeric/special.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace study {
namespace {

void check_values(std::vector<double> const& values, std::vector<double> const& prior, char const* name)
{
    bool const numbers = std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
    if (values.empty() || !numbers)
        refuse(std::string("QUEST+ without a list of numbers for ") + name, "its grid needs one value or more",
               "give the values to consider");
    double sum = 0;
    bool good = prior.empty() || prior.size() == values.size();
    for (double const w : prior) {
        good = good && w >= 0 && std::isfinite(w);
        sum += w;
    }
    if (!good || (!prior.empty() && !(sum > 0)))
        refuse(std::string("the prior of ") + name, "it needs one weight from 0 up for each value, not all 0",
               "leave it out for a uniform prior");
}

void check(QuestSettings const& s)
{
    if (s.function == QuestFunction::formula && !s.formula)
        refuse("QUEST+ by a formula without one", "its function is unknown", "give settings.formula");
    check_values(s.stimuli, {}, "stimuli");
    check_values(s.threshold, s.threshold_prior, "threshold");
    check_values(s.slope, s.slope_prior, "slope");
    check_values(s.guess, s.guess_prior, "guess");
    check_values(s.lapse, s.lapse_prior, "lapse");
    auto const lowest = [](std::vector<double> const& v) { return *std::min_element(v.begin(), v.end()); };
    auto const highest = [](std::vector<double> const& v) { return *std::max_element(v.begin(), v.end()); };
    if (!(lowest(s.slope) > 0))
        refuse("a slope that is not above 0", "the curve would not rise", "use slopes above 0");
    if (s.function == QuestFunction::weibull && !(lowest(s.stimuli) > 0 && lowest(s.threshold) > 0))
        refuse("stimuli or thresholds that are not above 0", "Weibull's function takes their ratio",
               "use levels above 0, or dB with weibull_db");
    if (!(lowest(s.guess) >= 0 && lowest(s.lapse) >= 0 && highest(s.guess) + highest(s.lapse) < 1))
        refuse("guess or lapse rates below 0, or that together reach 1", "they leave no room for a curve",
               "use rates from 0 whose sum is below 1");
}

double weight(std::vector<double> const& prior, std::size_t i) { return prior.empty() ? 1 : prior[i]; }

} // namespace

double proportion_at(QuestFunction function, Direction direction, QuestParameters const& p, double x)
{
    double const sign = direction == Direction::rising ? 1 : -1;
    double const away = sign * (x - p.threshold);
    auto const weibull = [](double exponent) { return -std::expm1(-std::exp(std::fmin(exponent, 700))); };
    double f = 0;
    switch (function) {
    case QuestFunction::weibull_db:
        f = weibull(p.slope * away / 20 * std::log(10.0));
        break;
    case QuestFunction::weibull:
        f = weibull(sign * p.slope * std::log(x / p.threshold));
        break;
    case QuestFunction::gaussian:
        f = normal_cdf(away / p.slope);
        break;
    case QuestFunction::logistic:
        f = 1 / (1 + std::exp(-p.slope * away));
        break;
    case QuestFunction::gumbel:
        f = sigmoid(Sigmoid::weibull, away / p.slope).below;
        break;
    case QuestFunction::gumbel_right:
        f = sigmoid(Sigmoid::gumbel_right, away / p.slope).below;
        break;
    case QuestFunction::hyperbolic_secant:
        f = sigmoid(Sigmoid::hyperbolic_secant, away / p.slope).below;
        break;
    case QuestFunction::cauchy:
        f = sigmoid(Sigmoid::cauchy, away / p.slope).below;
        break;
    case QuestFunction::formula:
        return std::nan("");
    }
    return p.guess + (1 - p.guess - p.lapse) * f;
}

double proportion_by(QuestSettings const& s, QuestParameters const& p, double x)
{
    if (s.function != QuestFunction::formula) return proportion_at(s.function, s.direction, p, x);
    return (*s.formula)(std::array{x, p.threshold, p.slope, p.guess, p.lapse});
}

QuestPlus::QuestPlus(QuestSettings settings) : settings_(std::move(settings))
{
    QuestSettings const& s = settings_;
    check(s);
    std::size_t const cells = s.threshold.size() * s.slope.size() * s.guess.size() * s.lapse.size();
    for (std::size_t t = 0; t < s.threshold.size(); ++t)
        for (std::size_t k = 0; k < s.slope.size(); ++k)
            for (std::size_t g = 0; g < s.guess.size(); ++g)
                for (std::size_t l = 0; l < s.lapse.size(); ++l)
                    posterior_.push_back(weight(s.threshold_prior, t) * weight(s.slope_prior, k) *
                                         weight(s.guess_prior, g) * weight(s.lapse_prior, l));
    normalise(posterior_);
    correct_ = noise_ = Matrix(s.stimuli.size(), cells);
    for (std::size_t i = 0; i < s.stimuli.size(); ++i)
        for (std::size_t c = 0; c < cells; ++c) {
            double const p = proportion_by(s, parameters(c), s.stimuli[i]);
            if (!(p >= 0 && p <= 1))
                refuse("the function gives " + std::to_string(p) + " at " + std::to_string(s.stimuli[i]),
                       "a proportion lies between 0 and 1", "correct the formula or the grids");
            correct_(i, c) = p;
            noise_(i, c) = entropy_of_event(p);
        }
}

QuestParameters QuestPlus::parameters(std::size_t cell) const
{
    QuestSettings const& s = settings_;
    auto const take = [&](std::vector<double> const& values) {
        double const v = values[cell % values.size()];
        cell /= values.size();
        return v;
    };
    QuestParameters p;
    p.lapse = take(s.lapse);
    p.guess = take(s.guess);
    p.slope = take(s.slope);
    p.threshold = take(s.threshold);
    return p;
}

double QuestPlus::entropy() const
{
    double sum = 0;
    for (double const p : posterior_) sum -= p_log2_p(p);
    return sum;
}

double QuestPlus::expected_information(std::size_t stimulus) const
{
    // I(parameters; response) = H(response) - H(response | parameters)
    double right = 0, noise = 0;
    for (std::size_t c = 0; c < posterior_.size(); ++c) {
        right += posterior_[c] * correct_(stimulus, c);
        noise += posterior_[c] * noise_(stimulus, c);
    }
    return entropy_of_event(right) - noise;
}

std::size_t QuestPlus::next() const
{
    std::vector<double> gain;
    for (std::size_t i = 0; i < settings_.stimuli.size(); ++i) gain.push_back(expected_information(i));
    double const most = *std::max_element(gain.begin(), gain.end());
    for (std::size_t i = 0; i < gain.size(); ++i)
        if (gain[i] >= most - settings_.tie_tolerance) return i;
    return 0;
}

void QuestPlus::respond(std::size_t stimulus, bool correct)
{
    if (stimulus >= settings_.stimuli.size())
        refuse("stimulus " + std::to_string(stimulus),
               "there are " + std::to_string(settings_.stimuli.size()) + " on the grid", "give an index of these");
    std::vector<double> updated = posterior_;
    for (std::size_t c = 0; c < updated.size(); ++c)
        updated[c] *= correct ? correct_(stimulus, c) : 1 - correct_(stimulus, c);
    normalise(updated);
    posterior_ = std::move(updated);
}

QuestParameters QuestPlus::mode() const
{
    return parameters(std::size_t(std::max_element(posterior_.begin(), posterior_.end()) - posterior_.begin()));
}

template <class Value>
QuestParameters QuestPlus::expectation(Value const& value) const
{
    QuestParameters sum{0, 0, 0, 0};
    for (std::size_t c = 0; c < posterior_.size(); ++c) {
        QuestParameters const v = value(parameters(c));
        sum.threshold += posterior_[c] * v.threshold;
        sum.slope += posterior_[c] * v.slope;
        sum.guess += posterior_[c] * v.guess;
        sum.lapse += posterior_[c] * v.lapse;
    }
    return sum;
}

QuestParameters QuestPlus::mean() const
{
    return expectation([](QuestParameters const& p) { return p; });
}

QuestParameters QuestPlus::standard_deviation() const
{
    QuestParameters const m = mean();
    auto const square = [](double v) { return v * v; };
    QuestParameters const variance = expectation([&](QuestParameters const& p) {
        return QuestParameters{square(p.threshold - m.threshold), square(p.slope - m.slope),
                               square(p.guess - m.guess), square(p.lapse - m.lapse)};
    });
    return {std::sqrt(variance.threshold), std::sqrt(variance.slope), std::sqrt(variance.guess),
            std::sqrt(variance.lapse)};
}

} // namespace study
