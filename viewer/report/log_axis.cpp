#include "viewer/report/log_axis.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>

namespace viewer {
namespace {

constexpr std::array kSteps{1.0, 2.0, 5.0};

/// Value of a step: ... -3 -> 0.1, -2 -> 0.2, -1 -> 0.5, 0 -> 1, 1 -> 2, ...
double step(int i)
{
    int const decade = int(std::floor(double(i) / double(kSteps.size())));
    return kSteps[std::size_t(i - decade * int(kSteps.size()))] * std::pow(10.0, decade);
}

/// Largest step at or below the value, up to rounding.
int step_below(double value)
{
    constexpr double kRounding = 1 + 1e-9;
    int i = int(std::floor(std::log10(value))) * int(kSteps.size()) - 1;
    while (step(i + 1) <= value * kRounding) ++i;
    return i;
}

std::string superscript(int number)
{
    static constexpr std::array kDigits{"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
    std::string text = number < 0 ? "⁻" : "";
    for (char const c : std::to_string(std::abs(number))) text += kDigits[std::size_t(c - '0')];
    return text;
}

} // namespace

double LogAxis::position(double value) const { return std::log(value / low) / std::log(high / low); }

LogAxis make_axis(std::vector<double> const& values)
{
    constexpr int kMostSteps = 9;
    LogAxis axis;
    if (!values.empty()) {
        auto const [low, high] = std::minmax_element(values.begin(), values.end());
        int const first = step_below(*low);
        int last = step_below(*high);
        if (last == first || step(last) < *high * (1 - 1e-9)) ++last;
        axis.low = step(first);
        axis.high = step(last);
    }
    int const first = step_below(axis.low), last = step_below(axis.high);
    for (int i = first; i <= last; ++i)
        if (last - first <= kMostSteps || i % int(kSteps.size()) == 0) axis.ticks.push_back(step(i));
    return axis;
}

std::string tick_text(double value)
{
    int const decade = int(std::floor(std::log10(value) + 1e-9));
    if (decade >= -3 && decade <= 3) return fmt::format("{:.3g}", value);
    double const digit = std::round(value / std::pow(10.0, decade));
    return (digit == 1 ? std::string() : fmt::format("{:.0f}·", digit)) + "10" + superscript(decade);
}

} // namespace viewer
