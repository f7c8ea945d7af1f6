#include "study/display/geometry.h"

#include <cmath>
#include <numbers>

namespace study {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

double px_per_cm(ScreenGeometry const& s, bool is_down)
{
    return is_down ? s.height_px / s.height_cm : s.width_px / s.width_cm;
}

} // namespace

std::pair<double, double> pixels_per_cm(ScreenGeometry const& s)
{
    return {px_per_cm(s, false), px_per_cm(s, true)};
}

double pixels_per_degree(ScreenGeometry const& s)
{
    return s.distance_cm > 0 ? px_per_cm(s, false) * s.distance_cm * kDegree : std::nan("");
}

double px_of_size(ScreenGeometry const& s, double deg, bool is_down)
{
    return px_per_cm(s, is_down) * 2 * s.distance_cm * std::tan(0.5 * deg * kDegree);
}

double px_of_place(ScreenGeometry const& s, double deg, bool is_down)
{
    return px_per_cm(s, is_down) * s.distance_cm * std::tan(deg * kDegree);
}

double deg_of_place(ScreenGeometry const& s, double px, bool is_down)
{
    return std::atan(px / px_per_cm(s, is_down) / s.distance_cm) / kDegree;
}

std::array<double, 3> direction_of_place(ScreenGeometry const& s, std::pair<double, double> px)
{
    double const x = px.first / px_per_cm(s, false), y = px.second / px_per_cm(s, true);
    double const length = std::hypot(x, y, s.distance_cm);
    return {x / length, y / length, s.distance_cm / length};
}

double deg_between(ScreenGeometry const& s, std::pair<double, double> a, std::pair<double, double> b)
{
    double const ax = a.first / px_per_cm(s, false), ay = a.second / px_per_cm(s, true);
    double const bx = b.first / px_per_cm(s, false), by = b.second / px_per_cm(s, true), d = s.distance_cm;
    // The cross product keeps small angles exact.
    double const cx = ay * d - d * by, cy = d * bx - ax * d, cz = ax * by - ay * bx;
    return std::atan2(std::sqrt(cx * cx + cy * cy + cz * cz), ax * bx + ay * by + d * d) / kDegree;
}

std::pair<double, double> screen_deg(ScreenGeometry const& s)
{
    return {2 * deg_of_place(s, 0.5 * s.width_px, false), 2 * deg_of_place(s, 0.5 * s.height_px, true)};
}

} // namespace study
