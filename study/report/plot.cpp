#include "study/report/plot.h"

#include "gi/core/html.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace study {

std::string short_number(double v)
{
    if (v == 0) return "0";
    if (std::abs(v) >= 1000 && std::abs(v) < 1e7) return fmt::format("{:.0f}", v);
    std::string text = fmt::format("{:.3g}", v);
    if (text.starts_with("-")) text.replace(0, 1, "−");
    return text;
}

double text_width(std::string_view text)
{
    auto const characters = std::count_if(text.begin(), text.end(),
                                          [](char c) { return (static_cast<unsigned char>(c) & 0xc0) != 0x80; });
    return 7.0 * double(characters);
}

double Axis1D::position(double v) const
{
    double const p =
        is_log ? (std::log(v) - std::log(low)) / (std::log(high) - std::log(low)) : (v - low) / (high - low);
    return std::isnan(p) ? -0.02 : std::clamp(p, -0.02, 1.02);
}

std::vector<double> Axis1D::ticks(int about) const
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

Axis1D axis_over(std::vector<double> const& values, bool is_log, double margin)
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

Plot::Plot(double width, double height, Axis1D x, Axis1D y) : width_(width), height_(height), x_(x), y_(y) {}

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
            (top() + bottom()) / 2, gi::escaped(label));
}

void Plot::line(double x1, double y1, double x2, double y2, char const* style)
{
    body_ += fmt::format("<line class=\"{}\" x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\"/>", style, x1,
                         y1, x2, y2);
}

void Plot::dot(double cx, double cy, double r, char const* style)
{
    body_ += fmt::format("<circle class=\"{}\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{:.1f}\"/>", style, cx, cy, r);
}

void Plot::diamond(double cx, double cy, double r, char const* style)
{
    body_ += fmt::format("<path class=\"{}\" d=\"M{:.1f} {:.1f}l{:.1f} {:.1f}l{:.1f} {:.1f}l{:.1f} {:.1f}z\"/>",
                         style, cx, cy - r, r, r, -r, r, -r, -r);
}

void Plot::box(double bx, double by, double w, double h, char const* style)
{
    body_ += fmt::format("<rect class=\"{}\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\"/>",
                         style, bx, by, std::max(0.0, w), std::max(0.0, h));
}

void Plot::text(double tx, double ty, std::string_view words, char const* anchor, char const* style)
{
    body_ += fmt::format("<text class=\"{}\" x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>", style, tx,
                         ty, anchor, gi::escaped(words));
}

void Plot::polyline(std::vector<std::pair<double, double>> const& points, char const* style)
{
    body_ += fmt::format("<polyline class=\"{}\" points=\"", style);
    for (auto const& [px, py] : points) body_ += fmt::format("{:.1f},{:.1f} ", px, py);
    body_ += "\"/>";
}

std::string Plot::svg(std::string const& title) const
{
    return fmt::format("<svg role=\"img\" viewBox=\"0 0 {0:.0f} {1:.0f}\" width=\"{0:.0f}\" height=\"{1:.0f}\">"
                       "<title>{2}</title>{3}</svg>",
                       width_, height_, gi::escaped(title), body_);
}

std::string Plot::figure(std::string const& title, std::string const& caption) const
{
    return fmt::format("<figure style=\"width: {:.0f}px\">{}<figcaption>{}</figcaption></figure>\n", width_,
                       svg(title), caption);
}

} // namespace study
