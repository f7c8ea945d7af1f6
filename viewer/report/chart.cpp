#include "viewer/report/chart.h"

#include "gi/core/html/html.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace viewer {

std::string to_figure(Chart const& chart)
{
    auto const has_logarithm = [](double v) { return v > 0 && std::isnormal(v); };
    std::vector<gi::PlotSeries> curves = chart.curves;
    std::size_t left_out = 0;
    std::vector<double> xs, ys;
    double name_px = 0;
    for (gi::PlotSeries& curve : curves) {
        left_out += std::erase_if(
            curve.points, [&](gi::PlotPoint const& p) { return !has_logarithm(p.x) || !has_logarithm(p.y); });
        std::ranges::sort(curve.points, {}, &gi::PlotPoint::x);
        for (gi::PlotPoint& p : curve.points) {
            if (!has_logarithm(p.y_low)) p.y_low = p.y_high = p.y;
            xs.push_back(p.x);
            ys.insert(ys.end(), {p.y, p.y_low, p.y_high});
        }
        name_px = std::max(name_px, gi::text_width(curve.label));
    }
    // Include the level only if it is near the curves; a distant one would compress them.
    constexpr double kNear = 10;
    bool const has_level =
        chart.level > 0 && !ys.empty() && chart.level * kNear > *std::min_element(ys.begin(), ys.end());
    if (has_level) ys.push_back(chart.level);
    constexpr double kLeft = 64, kInner = 400, kHeight = 274, kBelow = 46;
    double const right = name_px + 20, above = gi::legend_height(curves, kInner + right);
    gi::Plot p(kLeft + kInner + right, above + kHeight + kBelow, gi::axis_over(xs, true), gi::axis_over(ys, true));
    p.margins(kLeft, above, right, kBelow);
    p.x_axis(chart.x_label);
    p.y_axis(chart.y_label);
    if (has_level) {
        p.line(p.left(), p.y(chart.level), p.right(), p.y(chart.level), "level");
        p.text(p.left() + 6, p.y(chart.level) - 5, chart.level_label, "start", "tick");
    }
    p.series(curves);
    std::string note;
    if (left_out > 0)
        note = fmt::format("; {} point{} without a logarithm left out", left_out, left_out == 1 ? "" : "s");
    return p.figure(chart.title, gi::escaped(chart.title + note));
}

} // namespace viewer
