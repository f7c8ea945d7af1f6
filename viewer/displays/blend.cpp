#include "viewer/displays/blend.h"

#include <algorithm>
#include <cmath>

namespace viewer {
namespace {

double rise(double distance_m, double band_m, double power)
{
    if (!(band_m > 0)) return 1;
    double const t = std::clamp(distance_m / band_m, 0.0, 1.0);
    return t < 0.5 ? 0.5 * std::pow(2 * t, power) : 1 - 0.5 * std::pow(2 * (1 - t), power);
}

} // namespace

double blend_weight(WallBlend const& b, double width_m, double height_m, double u, double v)
{
    if (!(u >= 0 && u <= 1 && v >= 0 && v <= 1)) return 0;
    return rise(u * width_m, b.left_m, b.power) * rise((1 - u) * width_m, b.right_m, b.power) *
           rise(v * height_m, b.bottom_m, b.power) * rise((1 - v) * height_m, b.top_m, b.power);
}

double encoded_weight(WallBlend const& b, double weight) { return std::pow(weight, 1 / b.gamma); }

bool needs_finish(Wall const& wall)
{
    WallBlend const& b = wall.blend;
    return is_warped(wall) || wall.blend_picture || wall.black_level_picture || wall.gain != gi::dvec3{1} ||
           b.left_m > 0 || b.right_m > 0 || b.top_m > 0 || b.bottom_m > 0;
}

} // namespace viewer
