#include "gi/core/html/plot.h"

#include "gi/core/html/html.h"
#include "gi/core/text.h"
#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <iterator>
#include <tuple>

namespace gi {
namespace {

constexpr std::size_t kSeriesColours = 6;

double row_names_width(std::vector<std::string> const& names)
{
    double width = 60;
    for (std::string const& n : names) width = std::max(width, text_width(n) + 16);
    return width;
}

} // namespace

double text_width(std::string_view text) { return 7.0 * double(characters(text)); }

Plot::Plot(double width, double height, PlotAxis x, PlotAxis y) : width_(width), height_(height), x_(x), y_(y) {}

void Plot::margins(double left, double top, double right, double bottom)
{
    left_ = left;
    top_ = top;
    right_ = right;
    bottom_ = bottom;
}

double Plot::x(double value) const { return left() + x_.position(value) * (right() - left()); }
double Plot::y(double value) const { return bottom() - y_.position(value) * (bottom() - top()); }

void Plot::x_axis(std::string const& label, int ticks)
{
    for (double const v : x_.ticks(ticks)) {
        line(x(v), top(), x(v), bottom(), "grid");
        text(x(v), bottom() + 16, short_number(v), "middle", "tick");
    }
    line(left(), bottom(), right(), bottom(), "axis");
    text((left() + right()) / 2, bottom() + 34, label, "middle", "label");
}

void Plot::y_axis(std::string const& label, int ticks)
{
    for (double const v : y_.ticks(ticks)) {
        line(left(), y(v), right(), y(v), "grid");
        text(left() - 6, y(v) + 4, short_number(v), "end", "tick");
    }
    line(left(), top(), left(), bottom(), "axis");
    if (!label.empty())
        body_ += fmt::format(
            "<text class=\"label\" text-anchor=\"middle\" transform=\"translate(14 {:.1f}) rotate(-90)\">"
            "{}</text>",
            (top() + bottom()) / 2, escaped(label));
}

namespace {

constexpr double kLegendTop = 20, kLegendLine = 18; // px

double entry_width(PlotSeries const& s) { return 30 + text_width(s.label); }

} // namespace

double legend_height(std::vector<PlotSeries> const& all, double width)
{
    double x = 0, height = 2 * kLegendTop;
    for (PlotSeries const& s : all) {
        if (x > 0 && x + entry_width(s) > width) x = 0, height += kLegendLine;
        x += entry_width(s) + 22;
    }
    return height;
}

void Plot::series(std::vector<PlotSeries> const& all)
{
    constexpr double kLine = 15;
    struct Name {
        std::size_t series;
        double x, y;
    };
    std::vector<Name> names;
    double legend = left(), legend_y = kLegendTop;
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (legend > left() && legend + entry_width(all[i]) > width_) legend = left(), legend_y += kLegendLine;
        constexpr char const* kStrokes[]{"", " dashed", " dotted"}; // where colours repeat
        body_ += fmt::format("<g class=\"c{}{}\">", i % kSeriesColours,
                             kStrokes[i / kSeriesColours % std::size(kStrokes)]);
        std::vector<std::pair<double, double>> path;
        for (PlotPoint const& p : all[i].points) path.emplace_back(p.x, p.y);
        curve(path, "curve");
        for (PlotPoint const& p : all[i].points) {
            if (p.y_low < p.y_high) line(x(p.x), y(p.y_low), x(p.x), y(p.y_high), "spread");
            marker(i, x(p.x), y(p.y), fmt::format("{}: {:.3g} at {:.3g}", all[i].label, p.y, p.x));
        }
        line(legend, legend_y, legend + 24, legend_y, "curve");
        marker(i, legend + 12, legend_y, "");
        body_ += "</g>\n";
        text(legend + 30, legend_y + 4, all[i].label);
        legend += entry_width(all[i]) + 22;
        if (!path.empty()) names.push_back({i, x(path.back().first) + 10, y(path.back().second) + 4});
    }
    // Names are pushed apart where they would overlap, and back up if the last ones are below the axis.
    std::sort(names.begin(), names.end(), [](Name const& a, Name const& b) { return a.y < b.y; });
    for (std::size_t i = 1; i < names.size(); ++i) names[i].y = std::max(names[i].y, names[i - 1].y + kLine);
    double lowest = bottom() - 2;
    for (auto n = names.rbegin(); n != names.rend(); ++n, lowest -= kLine) {
        n->y = std::min(n->y, lowest);
        text(n->x, n->y, all[n->series].label, "start", fmt::format("name c{}", n->series % kSeriesColours));
    }
}

void Plot::curve(std::vector<std::pair<double, double>> points, std::string_view style)
{
    for (auto& [px, py] : points) std::tie(px, py) = std::pair(x(px), y(py));
    polyline(points, style);
}

void Plot::estimate(double value, double low, double high, double row)
{
    if (std::isfinite(low) || std::isfinite(high)) // an open end goes to the border; beyond it are the names
        line(std::isfinite(low) ? std::max(left(), x(low)) : left(), row, std::isfinite(high) ? x(high) : right(),
             row, "interval");
    if (std::isfinite(value)) dot(x(value), row, 4, "point");
}

void Plot::line(double x1, double y1, double x2, double y2, std::string_view style)
{
    body_ += fmt::format("<line class=\"{}\" x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\"/>", style, x1,
                         y1, x2, y2);
}

void Plot::dot(double cx, double cy, double r, std::string_view style)
{
    body_ += fmt::format("<circle class=\"{}\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{:.1f}\"/>", style, cx, cy, r);
}

void Plot::diamond(double cx, double cy, double r, std::string_view style)
{
    body_ += fmt::format("<path class=\"{}\" d=\"M{:.1f} {:.1f}l{:.1f} {:.1f}l{:.1f} {:.1f}l{:.1f} {:.1f}z\"/>",
                         style, cx, cy - r, r, r, -r, r, -r, -r);
}

/// Shapes that distinguish series without colours: circle, square, triangle.
void Plot::marker(std::size_t kind, double cx, double cy, std::string const& hint)
{
    constexpr std::array kShapes{"M-4 0a4 4 0 1 0 8 0a4 4 0 1 0-8 0z", "M-4-4h8v8h-8z", "M0-5.6L5.2 4h-10.4z"};
    body_ +=
        fmt::format("<path transform=\"translate({:.1f} {:.1f})\" d=\"{}\">{}</path>", cx, cy,
                    kShapes[kind % kShapes.size()], hint.empty() ? "" : "<title>" + escaped(hint) + "</title>");
}

void Plot::box(double bx, double by, double w, double h, std::string_view style)
{
    body_ += fmt::format("<rect class=\"{}\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\"/>",
                         style, bx, by, std::max(0.0, w), std::max(0.0, h));
}

void Plot::text(double tx, double ty, std::string_view words, std::string_view anchor, std::string_view style)
{
    body_ += fmt::format("<text class=\"{}\" x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>", style, tx,
                         ty, anchor, escaped(words));
}

void Plot::polyline(std::vector<std::pair<double, double>> const& points, std::string_view style)
{
    body_ += fmt::format("<polyline class=\"{}\" points=\"", style);
    for (auto const& [px, py] : points) body_ += fmt::format("{:.1f},{:.1f} ", px, py);
    body_ += "\"/>";
}

std::string Plot::svg(std::string const& title) const
{
    return fmt::format("<svg role=\"img\" viewBox=\"0 0 {0:.0f} {1:.0f}\" width=\"{0:.0f}\" height=\"{1:.0f}\">"
                       "<title>{2}</title>{3}</svg>\n",
                       width_, height_, escaped(title), body_);
}

std::string Plot::figure(std::string const& title, std::string const& caption_html) const
{
    return html_figure(svg(title), caption_html, width_);
}

RowPlot::RowPlot(std::vector<std::string> const& names, PlotAxis x, std::string const& label, double inner_px,
                 double right_px, int ticks)
    : Plot(row_names_width(names) + inner_px + right_px, kRow * double(names.size()) + 62, x, {})
{
    margins(row_names_width(names), 8, right_px, 46);
    x_axis(label, ticks);
    for (std::size_t k = 0; k < names.size(); ++k) text(left() - 8, row(k) + 4, names[k], "end");
}

} // namespace gi
