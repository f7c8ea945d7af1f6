#pragma once
// Quantiles and medians of samples: one definition for the whole project. Header-only, without dependencies.
//
// Quantiles follow definition 7 of Hyndman & Fan 1996 (Amer. Stat. 50:361), the default of numpy and R: among n
// sorted values, the value at position (n - 1) p, counted from 0, interpolated linearly between neighbours. So
// p = 0 is the smallest value, p = 1 the largest and p = 0.5 the usual median.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

namespace gi {

/// Position of a quantile among sorted values: fraction `share` of the way from value `below` to the next.
struct QuantilePlace {
    std::size_t below = 0;
    double share = 0; ///< in [0, 1); 0 at the last value
};

/// @param count  number of values, at least 1
/// @param p  in [0, 1]
/// @throws std::invalid_argument p outside [0, 1] or NaN; no values
inline QuantilePlace quantile_place(std::size_t count, double p)
{
    if (!(p >= 0 && p <= 1)) throw std::invalid_argument("the quantile's p is outside 0 to 1");
    if (count == 0) throw std::invalid_argument("a quantile needs at least one value");
    double const at = double(count - 1) * p;
    std::size_t const below = std::min(std::size_t(at), count - 1);
    return {below, below + 1 < count ? at - double(below) : 0};
}

/// Linear interpolation between two neighbours; exact if they are equal, even if both are infinite.
inline double interpolated(double low, double high, double share)
{
    return share == 0 || low == high ? low : std::lerp(low, high, share);
}

/// @param sorted  in ascending order, without NaN
/// @param p  in [0, 1]
/// @return NaN if there are no values
/// @throws std::invalid_argument p outside [0, 1] or NaN
template <class T>
double quantile_of_sorted(std::span<T const> sorted, double p)
{
    QuantilePlace const at = quantile_place(std::max<std::size_t>(sorted.size(), 1), p);
    if (sorted.empty()) return std::numeric_limits<double>::quiet_NaN();
    return interpolated(double(sorted[at.below]), double(sorted[at.below + (at.share > 0)]), at.share);
}
template <class T>
double quantile_of_sorted(std::vector<T> const& sorted, double p)
{
    return quantile_of_sorted(std::span<T const>(sorted), p);
}

/// Returns the values in ascending order, without NaNs. Use it to take several quantiles of the same values.
template <class T>
std::vector<T> sorted_values(std::vector<T> values)
{
    std::erase_if(values, [](T v) { return std::isnan(v); });
    std::sort(values.begin(), values.end());
    return values;
}

/// @param values  in any order; NaNs are ignored
/// @param p  in [0, 1]
/// @return NaN if there are no values besides NaNs
/// @throws std::invalid_argument p outside [0, 1] or NaN
template <class T>
double quantile(std::vector<T> values, double p)
{
    std::erase_if(values, [](T v) { return std::isnan(v); });
    QuantilePlace const at = quantile_place(std::max<std::size_t>(values.size(), 1), p);
    if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
    auto const below = values.begin() + std::ptrdiff_t(at.below);
    std::nth_element(values.begin(), below, values.end());
    double const low = double(*below);
    return at.share == 0 ? low : interpolated(low, double(*std::min_element(below + 1, values.end())), at.share);
}

/// Definition 5 of Hyndman & Fan (Hazen), the default of MATLAB: the value at position n p - 1/2, counted from 0,
/// interpolated linearly and clamped to the first and last value. Use it only to match published MATLAB code.
/// @param values  in any order; NaNs are ignored
/// @param p  in [0, 1]
/// @return NaN if there are no values besides NaNs
/// @throws std::invalid_argument p outside [0, 1] or NaN
template <class T>
double hazen_quantile(std::vector<T> values, double p)
{
    values = sorted_values(std::move(values));
    if (values.size() < 2) return quantile_of_sorted(values, p);
    if (!(p >= 0 && p <= 1)) throw std::invalid_argument("the quantile's p is outside 0 to 1");
    double const last = double(values.size() - 1);
    return quantile_of_sorted(values, std::clamp(double(values.size()) * p - 0.5, 0.0, last) / last);
}

/// Same as quantile(values, 0.5); for an even number of values, the mean of the two middle ones.
template <class T>
double median(std::vector<T> values)
{
    return quantile(std::move(values), 0.5);
}

/// Value below which half of the total weight lies. If exactly half lies on either side, the mean of the two
/// neighbours, so that equal weights give the median.
/// @param values  pairs of value and weight (>= 0) in any order; pairs with a NaN or with weight 0 are ignored
/// @return NaN if the total weight is 0
template <class T>
double weighted_median(std::vector<std::pair<T, T>> values)
{
    std::erase_if(values, [](auto const& v) { return std::isnan(v.first) || !(v.second > 0); });
    std::sort(values.begin(), values.end());
    double total = 0, below = 0;
    for (auto const& [value, weight] : values) total += double(weight);
    for (std::size_t i = 0; i < values.size(); ++i) {
        double const up_to = below + double(values[i].second);
        if (up_to == 0.5 * total && i + 1 < values.size())
            return interpolated(double(values[i].first), double(values[i + 1].first), 0.5);
        if (up_to >= 0.5 * total) return double(values[i].first);
        below = up_to;
    }
    return std::numeric_limits<double>::quiet_NaN();
}

} // namespace gi
