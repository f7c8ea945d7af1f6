#include "viewer/xr/visibility.h"

#include <algorithm>
#include <cmath>

namespace viewer {
namespace {

double side(glm::dvec2 a, glm::dvec2 b, glm::dvec2 p)
{
    return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
}

/// First and last pixel whose middle may lie between two positions.
std::pair<int, int> middles(double from, double to, int size)
{
    auto const clamped = [&](double v) { return int(std::clamp(v, 0.0, double(size))); };
    return {clamped(std::ceil(from - 0.5)), clamped(std::floor(to - 0.5) + 1)};
}

} // namespace

std::vector<std::uint8_t> hidden_pixels(HiddenMask const& mask, gi::ViewTangents const& view, int width,
                                        int height)
{
    std::vector<std::uint8_t> hidden(std::size_t(width) * std::size_t(height), 0);
    auto const pixel = [&](gi::vec2 tangent) {
        return glm::dvec2((tangent.x - view.left) / (view.right - view.left) * width,
                          (view.top - tangent.y) / (view.top - view.bottom) * height);
    };
    for (std::size_t i = 0; i + 2 < mask.triangles.size(); i += 3) {
        glm::dvec2 corner[3];
        bool is_whole = true;
        for (std::size_t k = 0; k < 3; ++k) {
            std::size_t const index = mask.triangles[i + k];
            is_whole = is_whole && index < mask.points.size();
            if (is_whole) corner[k] = pixel(mask.points[index]);
        }
        double const area = is_whole ? side(corner[0], corner[1], corner[2]) : 0;
        if (!std::isfinite(area) || area == 0) continue;
        if (area < 0) std::swap(corner[1], corner[2]);
        auto const [x0, x1] = middles(std::min({corner[0].x, corner[1].x, corner[2].x}),
                                      std::max({corner[0].x, corner[1].x, corner[2].x}), width);
        auto const [y0, y1] = middles(std::min({corner[0].y, corner[1].y, corner[2].y}),
                                      std::max({corner[0].y, corner[1].y, corner[2].y}), height);
        for (int y = y0; y < y1; ++y)
            for (int x = x0; x < x1; ++x) {
                glm::dvec2 const p(x + 0.5, y + 0.5);
                if (side(corner[0], corner[1], p) >= 0 && side(corner[1], corner[2], p) >= 0 &&
                    side(corner[2], corner[0], p) >= 0)
                    hidden[std::size_t(y) * std::size_t(width) + std::size_t(x)] = 1;
            }
    }
    return hidden;
}

} // namespace viewer
