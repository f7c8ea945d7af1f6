#include "viewer/report/chart.h"

#include "gi/core/html.h"
#include "viewer/report/html.h"
#include "viewer/report/log_axis.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace viewer {
namespace {

// Sizes in pixels; the right margin is for the names of the curves.
constexpr double kWidth = 560, kHeight = 360, kLeft = 64, kRight = 100, kTop = 40, kBottom = 52;
constexpr double kLine = 15, kMarker = 4, kCharacter = 7.5;

bool has_logarithm(CurvePoint const& p) { return p.x > 0 && p.y > 0 && std::isnormal(p.x) && std::isnormal(p.y); }

struct Frame {
    LogAxis x, y;

    double px(double value) const { return kLeft + x.position(value) * (kWidth - kLeft - kRight); }
    double py(double value) const { return kHeight - kBottom - y.position(value) * (kHeight - kTop - kBottom); }
    /// Clamps to the axes, as spreads and levels may exceed them.
    double clamped_py(double value) const { return py(std::clamp(value, y.low, y.high)); }
};

std::string text(double x, double y, char const* css, std::string const& words)
{
    return fmt::format("<text class=\"{}\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n", css, x, y, gi::escaped(words));
}

std::string line(char const* css, double x0, double y0, double x1, double y1)
{
    return fmt::format("<line class=\"{}\" x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\"/>\n", css, x0,
                       y0, x1, y1);
}

/// Marker whose shape distinguishes the curves without colours.
std::string marker(std::size_t curve, double x, double y, std::string const& note)
{
    double const r = kMarker;
    std::string const title = note.empty() ? "" : "<title>" + gi::escaped(note) + "</title>";
    if (curve % 3 == 0)
        return fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{}\">{}</circle>\n", x, y, r, title);
    std::string const corners = curve % 3 == 1
                                    ? fmt::format("{:.1f},{:.1f} {:.1f},{:.1f} {:.1f},{:.1f} {:.1f},{:.1f}", x - r,
                                                  y - r, x + r, y - r, x + r, y + r, x - r, y + r)
                                    : fmt::format("{:.1f},{:.1f} {:.1f},{:.1f} {:.1f},{:.1f}", x, y - 1.4 * r,
                                                  x + 1.3 * r, y + r, x - 1.3 * r, y + r);
    return fmt::format("<polygon points=\"{}\">{}</polygon>\n", corners, title);
}

std::string axes(Chart const& chart, Frame const& f)
{
    std::string svg;
    double const bottom = kHeight - kBottom, right = kWidth - kRight;
    for (double const tick : f.x.ticks) {
        svg += line("grid", f.px(tick), kTop, f.px(tick), bottom);
        svg += text(f.px(tick), bottom + 18, "tick middle", tick_text(tick));
    }
    for (double const tick : f.y.ticks) {
        svg += line("grid", kLeft, f.py(tick), right, f.py(tick));
        svg += text(kLeft - 8, f.py(tick) + 4, "tick end", tick_text(tick));
    }
    svg += line("axis", kLeft, bottom, right, bottom) + line("axis", kLeft, kTop, kLeft, bottom);
    svg += text(0.5 * (kLeft + right), kHeight - 10, "label middle", chart.x_label);
    svg += fmt::format("<text class=\"label middle\" transform=\"translate(16 {:.1f}) rotate(-90)\">{}</text>\n",
                       0.5 * (kTop + bottom), gi::escaped(chart.y_label));
    return svg;
}

std::string draw(Curve const& curve, std::size_t index, Frame const& f)
{
    std::string svg = fmt::format("<g class=\"curve c{}\">\n<polyline points=\"", index % kCurveStyles);
    for (CurvePoint const& p : curve.points) svg += fmt::format("{:.1f},{:.1f} ", f.px(p.x), f.py(p.y));
    svg += "\"/>\n";
    for (CurvePoint const& p : curve.points) {
        if (p.y_low > 0 && p.y_high > p.y_low)
            svg += line("spread", f.px(p.x), f.clamped_py(p.y_low), f.px(p.x), f.clamped_py(p.y_high));
        svg += marker(index, f.px(p.x), f.py(p.y), fmt::format("{}: {:.3g} at {:.3g}", curve.label, p.y, p.x));
    }
    return svg + "</g>\n";
}

/// Names at the ends of the curves, pushed apart where they would overlap.
std::string end_labels(std::vector<Curve> const& curves, Frame const& f)
{
    struct Label {
        std::size_t curve;
        double x, y;
    };
    std::vector<Label> labels;
    for (std::size_t i = 0; i < curves.size(); ++i)
        if (!curves[i].points.empty())
            labels.push_back({i, f.px(curves[i].points.back().x) + 10, f.py(curves[i].points.back().y) + 4});
    std::sort(labels.begin(), labels.end(), [](Label const& a, Label const& b) { return a.y < b.y; });
    for (std::size_t i = 1; i < labels.size(); ++i) labels[i].y = std::max(labels[i].y, labels[i - 1].y + kLine);
    double lowest = kHeight - kBottom - 2; // and back up if the last ones are below the axis
    for (auto l = labels.rbegin(); l != labels.rend(); ++l, lowest -= kLine) l->y = std::min(l->y, lowest);
    std::string svg;
    for (Label const& l : labels)
        svg += fmt::format("<g class=\"name c{}\">", l.curve % kCurveStyles) +
               text(l.x, l.y, "label", curves[l.curve].label) + "</g>\n";
    return svg;
}

std::string legend(std::vector<Curve> const& curves)
{
    std::string svg;
    double x = kLeft;
    for (std::size_t i = 0; i < curves.size(); ++i) {
        svg += fmt::format("<g class=\"curve c{}\">\n", i % kCurveStyles) + line("sample", x, 20, x + 24, 20) +
               marker(i, x + 12, 20, "") + "</g>\n" + text(x + 30, 24, "label", curves[i].label);
        x += 50 + kCharacter * double(curves[i].label.size());
    }
    return svg;
}

} // namespace

std::string to_svg(Chart const& chart)
{
    std::vector<Curve> curves = chart.curves;
    std::size_t left_out = 0;
    std::vector<double> xs, ys;
    for (Curve& curve : curves) {
        left_out += std::erase_if(curve.points, [](CurvePoint const& p) { return !has_logarithm(p); });
        std::sort(curve.points.begin(), curve.points.end(),
                  [](auto const& a, auto const& b) { return a.x < b.x; });
        for (CurvePoint const& p : curve.points) {
            xs.push_back(p.x);
            for (double const y : {p.y, p.y_low, p.y_high})
                if (y > 0 && std::isnormal(y)) ys.push_back(y);
        }
    }
    // Include the level only if it is near the curves; a distant one would compress them.
    constexpr double kNear = 10;
    if (!ys.empty() && chart.level * kNear > *std::min_element(ys.begin(), ys.end())) ys.push_back(chart.level);
    Frame const frame{make_axis(xs), make_axis(ys)};
    std::string svg = fmt::format("<svg viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{}\">\n", kWidth, kHeight,
                                  gi::escaped(chart.title));
    svg += axes(chart, frame);
    if (chart.level > 0 && chart.level >= frame.y.low && chart.level <= frame.y.high) {
        double const y = frame.py(chart.level);
        svg += line("level", kLeft, y, kWidth - kRight, y) + text(kLeft + 6, y - 5, "tick", chart.level_label);
    }
    for (std::size_t i = 0; i < curves.size(); ++i) svg += draw(curves[i], i, frame);
    svg += end_labels(curves, frame) + legend(curves) + "</svg>\n";
    if (left_out > 0)
        svg += fmt::format("<p class=\"note\">{} point{} without a logarithm left out.</p>\n", left_out,
                           left_out == 1 ? "" : "s");
    return svg;
}

} // namespace viewer
