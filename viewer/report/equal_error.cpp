#include "viewer/report/equal_error.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace viewer {
namespace {

constexpr double kFlattest = -0.05; // exponent of error over time; flatter curves are not extrapolated

bool usable(double v) { return std::isfinite(v) && v > 0; }

double exponent(ErrorAtTime const& a, ErrorAtTime const& b)
{
    return std::log(b.error / a.error) / std::log(b.seconds / a.seconds);
}

} // namespace

std::string_view to_text(Reached reached)
{
    switch (reached) {
    case Reached::between_budgets:
        return "";
    case Reached::in_first_picture:
        return "by the first picture";
    case Reached::beyond_budgets:
        return "extrapolated";
    case Reached::never:
        return "not reached";
    }
    return "";
}

TimeAtError time_at_error(std::vector<ErrorAtTime> curve, double error)
{
    TimeAtError const never{std::numeric_limits<double>::quiet_NaN(), Reached::never};
    std::erase_if(curve, [](ErrorAtTime const& p) { return !usable(p.seconds) || !usable(p.error); });
    if (curve.empty() || !usable(error)) return never;
    std::ranges::sort(curve, {}, &ErrorAtTime::seconds);
    auto const at = [&](ErrorAtTime const& a, double slope) {
        return a.seconds * std::exp(std::log(error / a.error) / slope);
    };
    if (curve.front().error <= error) return {curve.front().seconds, Reached::in_first_picture};
    for (std::size_t i = 1; i < curve.size(); ++i) {
        if (curve[i].error > error) continue;
        ErrorAtTime const &a = curve[i - 1], &b = curve[i];
        if (a.seconds == b.seconds) return {b.seconds, Reached::between_budgets};
        return {at(a, exponent(a, b)), Reached::between_budgets};
    }
    if (curve.size() < 2) return never;
    ErrorAtTime const &a = curve[curve.size() - 2], &b = curve.back();
    double const slope = a.seconds < b.seconds ? exponent(a, b) : 0;
    if (!(slope < kFlattest)) return never;
    return {at(b, slope), Reached::beyond_budgets};
}

} // namespace viewer
