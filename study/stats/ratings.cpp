#include "study/stats/ratings.h"

#include "study/numeric/error.h"
#include "study/numeric/special.h"
#include "study/stats/summary.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <optional>
#include <set>

namespace study {
namespace {

void check(Matrix const& ratings)
{
    for (double const r : ratings.values)
        if (std::isinf(r)) refuse("an infinite rating", "scales are finite", "use NaN for missing ratings");
}

std::vector<double> given(Matrix const& ratings, std::size_t item)
{
    std::vector<double> values;
    for (std::size_t o = 0; o < ratings.columns; ++o)
        if (!std::isnan(ratings(item, o))) values.push_back(ratings(item, o));
    return values;
}

Interval skewed_interval(MeanOpinion const& m, std::vector<double> const& values, double t)
{
    double const n = double(values.size());
    if (!(m.deviation > 0) || n < 3) return m.interval;
    double cubes = 0;
    for (double const v : values) cubes += std::pow((v - m.mean) / m.deviation, 3);
    double const skewness = 0.5 * cubes * n / ((n - 1) * (n - 2)), a = skewness / (3 * std::sqrt(n));
    if (std::abs(a) < 1e-9) return m.interval;
    auto const back = [&](double z) { return (std::cbrt(1 + 3 * a * (z - a / 2)) - 1) / a; };
    // The skewness of very few ratings may be extreme.
    auto const moderate = [&](double z) { return std::clamp(z, t / 2, 2 * t); };
    return {m.mean - moderate(back(t)) * m.standard_error, m.mean + moderate(-back(-t)) * m.standard_error};
}

void check(std::span<Rating const> ratings, int items, int observers)
{
    if (ratings.empty()) refuse("no ratings", "there is nothing to fit", "give one rating or more");
    for (Rating const& r : ratings) {
        if (!std::isfinite(r.value))
            refuse("a rating that is not finite", "scales are finite", "leave missing ratings out");
        if (r.item < 0 || r.item >= items || r.observer < 0 || r.observer >= observers)
            refuse("a rating of item " + std::to_string(r.item) + " by observer " + std::to_string(r.observer),
                   "there are " + std::to_string(items) + " and " + std::to_string(observers),
                   "number them from 0");
    }
}

constexpr double kLeastInconsistency = 1e-12; ///< of ratings that vary by about 1

/// Empty where the likelihood of an observer runs to infinity.
/// @param prior  number of ratings that the mean square of all observers counts as, in that of each
std::optional<RatingModel> alternating_fit(std::span<Rating const> ratings, std::size_t items,
                                           std::size_t observers, double prior)
{
    RatingModel m;
    std::vector<double> by_item(items, 0), by_observer(observers, 0);
    m.quality.assign(items, 0);
    for (Rating const& r : ratings) {
        m.quality[std::size_t(r.item)] += r.value;
        ++by_item[std::size_t(r.item)];
        ++by_observer[std::size_t(r.observer)];
    }
    for (std::size_t j = 0; j < items; ++j) m.quality[j] /= by_item[j];

    for (; m.iterations < 1000 && !m.converged; ++m.iterations) {
        m.bias.assign(observers, 0);
        for (Rating const& r : ratings)
            m.bias[std::size_t(r.observer)] += r.value - m.quality[std::size_t(r.item)];
        for (std::size_t o = 0; o < observers; ++o) m.bias[o] /= by_observer[o];

        std::vector<double> squares(observers, 0);
        double all = 0;
        for (Rating const& r : ratings) {
            auto const o = std::size_t(r.observer);
            double const rest = r.value - m.quality[std::size_t(r.item)] - m.bias[o];
            squares[o] += rest * rest;
            all += rest * rest / double(ratings.size());
        }
        constexpr double kLeastShare = 0.02;
        m.inconsistency.assign(observers, std::nan(""));
        for (std::size_t o = 0; o < observers; ++o) {
            if (by_observer[o] == 0) continue;
            double const own = std::sqrt((squares[o] + prior * all) / (by_observer[o] + prior));
            if (prior == 0 && own < std::max(kLeastInconsistency, kLeastShare * std::sqrt(all))) return {};
            m.inconsistency[o] = std::max(kLeastInconsistency, own);
        }

        std::vector<double> sum(items, 0), weight(items, 0);
        for (Rating const& r : ratings) {
            auto const j = std::size_t(r.item), o = std::size_t(r.observer);
            double const w = 1 / (m.inconsistency[o] * m.inconsistency[o]);
            sum[j] += w * (r.value - m.bias[o]);
            weight[j] += w;
        }
        double change = 0;
        m.quality_error.assign(items, std::nan(""));
        for (std::size_t j = 0; j < items; ++j) {
            if (by_item[j] == 0) continue;
            change = std::max(change, std::abs(sum[j] / weight[j] - m.quality[j]));
            m.quality[j] = sum[j] / weight[j];
            m.quality_error[j] = 1 / std::sqrt(weight[j]);
        }
        m.converged = change < 1e-9;
    }

    double mean_bias = 0, known = 0;
    for (double const b : m.bias)
        if (!std::isnan(b)) mean_bias += b, ++known;
    mean_bias /= known;
    for (double& b : m.bias) b -= mean_bias;
    for (double& q : m.quality) q += mean_bias;
    for (std::size_t o = 0; o < observers; ++o)
        m.bias_error.push_back(m.inconsistency[o] / std::sqrt(by_observer[o]));
    return m;
}

} // namespace

std::vector<MeanOpinion> mean_opinions(Matrix const& ratings, double confidence)
{
    check(ratings);
    if (!(confidence > 0 && confidence < 1))
        refuse("confidence " + std::to_string(confidence), "it is a probability", "use 0.95 for 95 %");
    std::vector<MeanOpinion> result;
    for (std::size_t j = 0; j < ratings.rows; ++j) {
        std::vector<double> const values = given(ratings, j);
        MeanOpinion m;
        m.observers = int(values.size());
        m.mean = without_rounding(mean(values), largest_of(values));
        m.deviation = standard_deviation(values);
        m.standard_error = m.deviation / std::sqrt(double(values.size()));
        if (m.deviation == 0) { // what others would answer is unknown
            m.interval = m.skewed = {std::nan(""), std::nan("")};
            result.push_back(m);
            continue;
        }
        double const half = student_quantile(0.5 + confidence / 2, double(values.size()) - 1) * m.standard_error;
        m.interval = {m.mean - half, m.mean + half};
        m.skewed = skewed_interval(m, values, student_quantile(0.5 + confidence / 2, double(values.size()) - 1));
        result.push_back(m);
    }
    return result;
}

Matrix transposed(Matrix const& table)
{
    Matrix t(table.columns, table.rows);
    for (std::size_t r = 0; r < table.rows; ++r)
        for (std::size_t c = 0; c < table.columns; ++c) t(c, r) = table(r, c);
    return t;
}

RatingModel fit_ratings(std::span<Rating const> ratings, int items, int observers)
{
    check(ratings, items, observers);
    auto const j = std::size_t(items), o = std::size_t(observers);
    std::vector<int> by_observer(o, 0);
    for (Rating const& r : ratings) ++by_observer[std::size_t(r.observer)];
    std::vector<Rating> used; // one rating is explained by its observer's bias
    std::set<int> rated;
    for (Rating const& r : ratings)
        if (by_observer[std::size_t(r.observer)] > 1) {
            used.push_back(r);
            rated.insert(r.item);
        }
    if (rated.size() < j) used.assign(ratings.begin(), ratings.end()); // an item that only they rated
    std::string note;
    if (std::size_t const n = ratings.size() - used.size(); n > 0)
        note = fmt::format("{} with one rating {} left out",
                           n == 1 ? "1 observer" : fmt::format("{} observers", n), n == 1 ? "is" : "are");
    auto const say = [&](char const* what) { note += (note.empty() ? "" : "; ") + std::string(what); };
    // The fit's limits are for ratings that vary by about 1 around 0.
    std::vector<double> values;
    for (Rating const& r : used) values.push_back(r.value);
    double const middle = mean(values), sd = standard_deviation(values), unit = sd > 0 ? sd : 1;
    for (Rating& r : used) r.value = sd > 0 ? (r.value - middle) / unit : 0;
    auto fit = alternating_fit(used, j, o, 0);
    bool const is_shrunken = !fit;
    constexpr double kPrior = 5;
    if (is_shrunken) fit = alternating_fit(used, j, o, kPrior);
    RatingModel m = *fit;
    if (*std::max_element(m.inconsistency.begin(), m.inconsistency.end(), [](double a, double b) {
            return std::isnan(a) || a < b; // NaN: nothing is known of this observer
        }) <= std::max(kLeastInconsistency, kRounding * largest_of(values) / unit)) {
        // All ratings are the sum of a quality and a bias: errors are not those of ratings of others.
        std::fill(m.quality_error.begin(), m.quality_error.end(), std::nan(""));
        std::fill(m.bias_error.begin(), m.bias_error.end(), std::nan(""));
        say("observers differ by constants alone: their inconsistency is 0, and nothing has an error");
    }
    for (double& q : m.quality) q = middle + unit * q;
    for (std::vector<double>* const list : {&m.quality_error, &m.bias, &m.bias_error, &m.inconsistency})
        for (double& v : *list) v *= unit;
    m.shrunken = is_shrunken;
    bool const is_perfect = std::isnan(m.quality_error.front());
    if (is_shrunken && !is_perfect)
        say("the likelihood is infinite where quality equals the ratings of an observer: inconsistencies of "
            "observers are drawn towards that of all");
    if (!m.converged) say("the fit did not converge");
    m.note = note;
    return m;
}

} // namespace study
