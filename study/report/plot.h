#pragma once
// Plots as inline SVG. Colours, fonts and line widths come from classes of the page's style sheet.

#include <string>
#include <string_view>
#include <vector>

namespace study {

/// Number with three digits, integers with up to seven: "0.05", "1250".
std::string short_number(double value);
/// Approximate width of a text in the plots' font of 12 px.
double text_width(std::string_view text);

struct Axis1D {
    double low = 0, high = 1;
    bool is_log = false;

    /// Position of a value, 0 at low, 1 at high; values beyond are placed just outside.
    double position(double value) const;
    std::vector<double> ticks(int about) const;
};
/// Axis over all finite values (logarithmic: all above 0), with a margin at both ends; [0, 1] if there are none.
Axis1D axis_over(std::vector<double> const& values, bool is_log = false, double margin = 0.06);

/// A rectangle with axes; data are drawn inside it, text at pixel positions around it.
class Plot {
public:
    Plot(double width, double height, Axis1D x, Axis1D y);
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
    // In pixels.
    void line(double x1, double y1, double x2, double y2, char const* style);
    void dot(double cx, double cy, double r, char const* style);
    void diamond(double cx, double cy, double r, char const* style);
    void box(double bx, double by, double w, double h, char const* style);
    /// @param anchor start, middle, end
    void text(double tx, double ty, std::string_view words, char const* anchor = "start", char const* style = "");
    void polyline(std::vector<std::pair<double, double>> const& points, char const* style);

    /// @param title  accessible title
    std::string svg(std::string const& title) const;
    /// The plot with a caption below it. @param caption HTML
    std::string figure(std::string const& title, std::string const& caption) const;

private:
    double width_, height_, left_ = 50, top_ = 12, right_ = 14, bottom_ = 42;
    Axis1D x_, y_;
    std::string body_;
};

} // namespace study
