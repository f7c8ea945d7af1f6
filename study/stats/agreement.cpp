#include "study/stats/agreement.h"

#include "study/numeric/error.h"
#include "study/numeric/special.h"
#include "study/stats/summary.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace study {
namespace {

/// Number of observers of a complete table.
int complete_observers(Matrix const& wins)
{
    std::size_t const n = wins.rows;
    if (n != wins.columns || n < 2)
        refuse("a table of " + std::to_string(n) + " x " + std::to_string(wins.columns),
               "choices need one row and one column for each of two items or more", "give a square table");
    double const m = wins(0, 1) + wins(1, 0);
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = 0; j < n; ++j)
            if (i != j && !(wins(i, j) >= 0 && wins(i, j) + wins(j, i) == m && m >= 1 && m == std::floor(m)))
                refuse("pair " + std::to_string(i) + ", " + std::to_string(j) + " was not judged " +
                           std::to_string(m) + " times",
                       "each observer must have judged every pair once", "use the deviance of fit_pairs instead");
    return int(m);
}

double choose2(double n) { return n * (n - 1) / 2; }

} // namespace

KendallU kendall_u(Matrix const& wins)
{
    KendallU r;
    r.observers = complete_observers(wins);
    r.items = int(wins.rows);
    double const m = r.observers, pairs = choose2(r.items);
    if (m < 2) refuse("agreement of one observer", "agreement needs two or more", "ask two or more");
    double s = 0;
    for (std::size_t i = 0; i < wins.rows; ++i)
        for (std::size_t j = 0; j < wins.rows; ++j)
            if (i != j) s += choose2(wins(i, j));
    r.u = 2 * s / (choose2(m) * pairs) - 1;
    r.minimum = -1 / (r.observers % 2 ? m : m - 1);
    if (r.observers == 2) {
        r.chi_square = r.chi_square_corrected = r.degrees_of_freedom = r.p = r.p_corrected = std::nan("");
        return r;
    }
    auto const chi_square = [&](double sum) {
        return 4 / (m - 2) * (sum - 0.5 * pairs * choose2(m) * (m - 3) / (m - 2));
    };
    r.chi_square = chi_square(s);
    r.chi_square_corrected = chi_square(s - 1);
    r.degrees_of_freedom = pairs * m * (m - 1) / ((m - 2) * (m - 2));
    r.p = chi_square_tail(r.chi_square, r.degrees_of_freedom);
    r.p_corrected = chi_square_tail(r.chi_square_corrected, r.degrees_of_freedom);
    return r;
}

EqualityTest equality_test(Matrix const& wins, double level)
{
    if (!(level > 0 && level < 1))
        refuse("level " + std::to_string(level), "it is a probability", "use 0.05 for 5 %");
    double const m = complete_observers(wins), n = double(wins.rows);
    EqualityTest r;
    double squares = 0;
    for (std::size_t i = 0; i < wins.rows; ++i) {
        double score = 0;
        for (std::size_t j = 0; j < wins.rows; ++j)
            if (i != j) score += wins(i, j);
        r.score.push_back(score);
        squares += score * score;
    }
    r.d = 4 * (squares - m * m * n * (n - 1) * (n - 1) / 4) / (m * n);
    r.degrees_of_freedom = int(wins.rows) - 1;
    r.p = chi_square_tail(r.d, r.degrees_of_freedom);
    r.studentized_range = normal_range_quantile(1 - level, int(wins.rows));
    r.range = r.studentized_range * std::sqrt(m * n) / 2 + 0.25;
    return r;
}

std::vector<double> midranks(std::span<double const> values)
{
    std::vector<std::size_t> order(values.size());
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
    std::vector<double> rank(values.size());
    double const size = largest_of(values);
    for (std::size_t i = 0; i < order.size();) {
        std::size_t end = i + 1;
        while (end < order.size() && is_rounding(values[order[end]] - values[order[i]], size)) ++end;
        for (std::size_t k = i; k < end; ++k) rank[order[k]] = double(i + 1 + end) / 2;
        i = end;
    }
    return rank;
}

Friedman friedman(Matrix const& values)
{
    std::size_t const n = values.columns;
    if (n < 2) refuse("one condition or none", "there is nothing to compare", "give two or more");
    Friedman r;
    r.conditions = int(n);
    r.mean_rank.assign(n, 0);
    double ties = 0;
    for (std::size_t o = 0; o < values.rows; ++o) {
        std::span<double const> const row(&values.values[o * n], n);
        if (std::any_of(row.begin(), row.end(), [](double v) { return std::isnan(v); })) {
            ++r.left_out;
            continue;
        }
        ++r.observers;
        std::vector<double> rank = midranks(row);
        for (std::size_t c = 0; c < n; ++c) r.mean_rank[c] += rank[c];
        for (std::size_t c = 0; c < n; ++c) // sum of t^3 - t over ties: each of t members adds t^2 - 1
            if (double const t = double(std::count(rank.begin(), rank.end(), rank[c])); t > 1) ties += t * t - 1;
    }
    if (r.observers == 0)
        refuse("no observer has a value for every condition", "ranks compare all conditions of one observer",
               "use a model that allows for missing values");
    double const m = r.observers, k = double(n);
    double squares = 0;
    for (double& rank : r.mean_rank) {
        squares += (rank - m * (k + 1) / 2) * (rank - m * (k + 1) / 2);
        rank /= m;
    }
    double const spread = m * k * (k + 1) - ties / (k - 1);
    r.degrees_of_freedom = int(n) - 1;
    r.is_tied = !(spread > 1e-9 * m * k * (k + 1));
    if (!r.is_tied) r.chi_square = 12 * squares / spread;
    r.p = chi_square_tail(r.chi_square, r.degrees_of_freedom);
    r.kendall_w = r.chi_square / (m * (k - 1));
    return r;
}

} // namespace study
