#include "study/stats/ratings.h"

#include "study/stats/error.h"
#include "study/stats/special.h"
#include "study/stats/summary.h"

#include <algorithm>
#include <cmath>

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

/// Calls use(item, observer, rating) for all ratings.
template <class Use>
void for_each(Matrix const& ratings, Use const& use)
{
    for (std::size_t j = 0; j < ratings.rows; ++j)
        for (std::size_t o = 0; o < ratings.columns; ++o)
            if (!std::isnan(ratings(j, o))) use(j, o, ratings(j, o));
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
        m.mean = mean(values);
        m.deviation = standard_deviation(values);
        m.standard_error = m.deviation / std::sqrt(double(values.size()));
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

RatingModel fit_ratings(Matrix const& ratings)
{
    check(ratings);
    constexpr double kLeastShare = 0.02;
    std::size_t const items = ratings.rows, observers = ratings.columns;
    RatingModel m;
    std::vector<double> by_item(items, 0), by_observer(observers, 0);
    for_each(ratings, [&](std::size_t j, std::size_t o, double) { ++by_item[j], ++by_observer[o]; });
    if (std::all_of(by_item.begin(), by_item.end(), [](double n) { return n == 0; }))
        refuse("no ratings", "there is nothing to fit", "give a table with one rating or more");

    for (MeanOpinion const& opinion : mean_opinions(ratings)) m.quality.push_back(opinion.mean);
    bool floored = false;
    for (; m.iterations < 1000 && !m.converged; ++m.iterations) {
        m.bias.assign(observers, 0);
        for_each(ratings, [&](std::size_t j, std::size_t o, double r) { m.bias[o] += r - m.quality[j]; });
        for (std::size_t o = 0; o < observers; ++o) m.bias[o] /= by_observer[o];

        std::vector<double> squares(observers, 0);
        double all = 0, count = 0;
        for_each(ratings, [&](std::size_t j, std::size_t o, double r) {
            double const rest = r - m.quality[j] - m.bias[o];
            squares[o] += rest * rest;
            all += rest * rest;
            ++count;
        });
        double const least = std::max(1e-12, kLeastShare * std::sqrt(all / count));
        m.inconsistency.clear();
        floored = false;
        for (std::size_t o = 0; o < observers; ++o) {
            double const own = std::sqrt(squares[o] / by_observer[o]);
            floored = floored || own < least;
            m.inconsistency.push_back(own < least ? least : own);
        }

        std::vector<double> sum(items, 0), weight(items, 0);
        for_each(ratings, [&](std::size_t j, std::size_t o, double r) {
            double const w = 1 / (m.inconsistency[o] * m.inconsistency[o]);
            sum[j] += w * (r - m.bias[o]);
            weight[j] += w;
        });
        double change = 0;
        m.quality_error.clear();
        for (std::size_t j = 0; j < items; ++j) {
            double const quality = weight[j] > 0 ? sum[j] / weight[j] : std::nan("");
            if (weight[j] > 0) change = std::max(change, std::abs(quality - m.quality[j]));
            m.quality[j] = quality;
            m.quality_error.push_back(weight[j] > 0 ? 1 / std::sqrt(weight[j]) : std::nan(""));
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
    if (floored)
        m.note = "the ratings of an observer match the model exactly: the inconsistency is set to its minimum";
    if (!m.converged) m.note += std::string(m.note.empty() ? "" : "; ") + "the fit did not converge";
    return m;
}

} // namespace study
