#include "ar/camera/camera_doubts.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace ar {

std::vector<std::string> doubts_about(CameraModel const& c)
{
    constexpr double kWidest_deg = 150, kNarrowest_deg = 1, kMostAspect = 1.2, kOffMiddle = 0.12;
    constexpr double kDegrees = 57.29577951308232;
    std::vector<std::string> all;
    double const width = c.size_px.x, height = c.size_px.y;
    double const view_deg = 2 * kDegrees * std::atan(0.5 * width / c.fx);
    if (c.lens != LensModel::fisheye && (view_deg > kWidest_deg || view_deg < kNarrowest_deg))
        all.push_back(
            fmt::format("a focal length of {:.4g} px in pictures {} px wide is a view of {:.3g} degrees: "
                        "is it in pixels?",
                        c.fx, c.size_px.x, view_deg));
    if (double const aspect = std::max(c.fx / c.fy, c.fy / c.fx); aspect > kMostAspect)
        all.push_back(fmt::format(
            "focal lengths of {:.4g} and {:.4g} px: pixels are nearly square in most cameras", c.fx, c.fy));
    double const right = (c.cx - 0.5 * (width - 1)) / width, down = (c.cy - 0.5 * (height - 1)) / height;
    if (std::abs(right) > kOffMiddle || std::abs(down) > kOffMiddle)
        all.push_back(fmt::format("the principal point ({:.4g}, {:.4g}) is far from the middle of {} x {} pixels: "
                                  "are x and y exchanged, or is it of another size?",
                                  c.cx, c.cy, c.size_px.x, c.size_px.y));
    return all;
}

} // namespace ar
