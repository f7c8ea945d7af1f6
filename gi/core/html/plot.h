#pragma once
// Plots as inline SVG. Colours, fonts and line widths are those of the page's style sheet:
// a "style" is a class there.

#include "gi/core/html/axis.h"

#include <string_view>
#include <utility>

namespace gi {

/// Approximate width of a text in the plots' font of 12 px.
double text_width(std::string_view text);

struct PlotPoint {
    double x = 0, y = 0;
    double y_low = 0, y_high = 0; ///< an error bar; none unless y_low < y_high
};
struct PlotSeries {
    std::string label;
    std::vector<PlotPoint> points; ///< in the order of the line that joins them
};

/// Pixels that a legend takes above a plot, in lines of at most `width` pixels.
double legend_height(std::vector<PlotSeries> const& all, double width);

/// A rectangle with axes; data are drawn inside it, text at pixel positions around it.
class Plot {
public:
    Plot(double width, double height, PlotAxis x, PlotAxis y);
    /// Sets the pixels between the rectangle and the borders; call before drawing.
    void margins(double left, double top, double right, double bottom);

    double x(double value) const;
    double y(double value) const;
    double left() const { return left_; }
    double right() const { return width_ - right_; }
    double top() const { return top_; }
    double bottom() const { return height_ - bottom_; }

    void x_axis(std::string const& label, int ticks = 5);
    void y_axis(std::string const& label, int ticks = 5);
    /// Lines with markers, names at their ends and a legend above, as high as legend_height() from the left margin to
    /// the right border; needs room at the right.
    void series(std::vector<PlotSeries> const& all);
    /// A curve without markers. @param points values
    void curve(std::vector<std::pair<double, double>> points, std::string_view style);
    /// A value with its interval, if it is known, along the horizontal at the pixel `row`. An end that is not
    /// finite is open, if the other is finite.
    void estimate(double value, double low, double high, double row);

    // In pixels.
    void line(double x1, double y1, double x2, double y2, std::string_view style);
    void dot(double cx, double cy, double r, std::string_view style);
    void diamond(double cx, double cy, double r, std::string_view style);
    void box(double bx, double by, double w, double h, std::string_view style);
    /// @param anchor start, middle, end
    void text(double tx, double ty, std::string_view words, std::string_view anchor = "start",
              std::string_view style = "");
    void polyline(std::vector<std::pair<double, double>> const& points, std::string_view style);

    /// @param title  accessible title
    std::string svg(std::string const& title) const;
    /// The plot with a caption below it.
    std::string figure(std::string const& title, std::string const& caption_html) const;

private:
    void marker(std::size_t kind, double cx, double cy, std::string const& hint);

    double width_, height_, left_ = 56, top_ = 12, right_ = 20, bottom_ = 46;
    PlotAxis x_, y_;
    std::string body_;
};

/// A plot with a row for each name, which stands at the left of its row; an axis below them.
class RowPlot : public Plot {
public:
    /// @param inner_px width of the rectangle @param right_px free at the right
    RowPlot(std::vector<std::string> const& names, PlotAxis x, std::string const& label, double inner_px,
            double right_px = 20, int ticks = 5);
    /// Vertical position of the middle of row k.
    double row(std::size_t k) const { return top() + kRow * (double(k) + 0.6); }
    static constexpr double kRow = 25; ///< height of a row, px
};

} // namespace gi
