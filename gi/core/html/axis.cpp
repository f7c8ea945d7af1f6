#include "gi/core/html/axis.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>

namespace gi {

std::string short_number(double v)
{
    static constexpr std::array kSuperscripts{"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
    if (v == 0) return "0";
    double const size = std::abs(v);
    std::string text = size >= 1000 && size < 1e7 ? fmt::format("{:.0f}", size) : fmt::format("{:.3g}", size);
    if (size < 1e-3 || text.find('e') != std::string::npos) {
        text = fmt::format("{:.2e}", size);
        auto const e = text.find('e');
        std::string const digits = fmt::format("{:g}", std::stod(text.substr(0, e)));
        int const power = std::stoi(text.substr(e + 1));
        text = (digits == "1" ? "" : digits + "·") + "10" + (power < 0 ? "⁻" : "");
        for (char const c : std::to_string(std::abs(power))) text += kSuperscripts[std::size_t(c - '0')];
    }
    return (v < 0 ? "−" : "") + text;
}

double PlotAxis::position(double v) const
{
    double const p =
        is_log ? (std::log(v) - std::log(low)) / (std::log(high) - std::log(low)) : (v - low) / (high - low);
    return std::isnan(p) ? -0.02 : std::clamp(p, -0.02, 1.02);
}

std::vector<double> PlotAxis::ticks(int about) const
{
    std::vector<double> out;
    if (is_log) {
        double const decades = std::log10(high / low);
        for (double power = std::floor(std::log10(low)); power <= std::log10(high); ++power)
            for (double const m : {1.0, 2.0, 5.0}) {
                double const v = m * std::pow(10.0, power);
                bool const is_wanted = decades < 2.2 || m == 1;
                if (is_wanted && v >= low * 0.999 && v <= high * 1.001) out.push_back(v);
            }
        if (out.size() >= 2) return out;
        out.clear();
    }
    // No ticks: steps would vanish in rounding.
    if (!(high - low > 1e-9 * std::max(std::abs(low), std::abs(high)))) return {low};
    double const raw = (high - low) / std::max(1, about), power = std::pow(10.0, std::floor(std::log10(raw)));
    double step = 10 * power;
    for (double const m : {5.0, 2.0, 1.0})
        if (m * power >= raw * 0.75) step = m * power;
    for (double v = std::ceil(low / step - 1e-9) * step; v <= high + 1e-9 * step; v += step)
        out.push_back(std::abs(v) < 1e-9 * step ? 0 : v);
    return out;
}

PlotAxis axis_over(std::vector<double> const& values, bool is_log, double margin)
{
    double low = 1e300, high = -1e300;
    for (double const v : values)
        if (std::isfinite(v) && (!is_log || v > 0)) {
            low = std::min(low, v);
            high = std::max(high, v);
        }
    if (low > high) return {is_log ? 1.0 : 0.0, is_log ? 10.0 : 1.0, is_log};
    if (is_log) {
        double const room = std::max(margin * std::log(high / low), 0.05);
        return {low * std::exp(-room), high * std::exp(room), true};
    }
    double const room = high > low ? margin * (high - low) : std::max(0.5, 0.1 * std::abs(high));
    return {low - room, high + room, false};
}

} // namespace gi
