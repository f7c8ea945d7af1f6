#include "study/gaze/heat_map.h"

#include "study/display/geometry.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace study {

HeatMap heat_map(std::vector<HeatSource> const& sources, ScreenGeometry const& screen, double sd_deg, int width)
{
    HeatMap map;
    map.width = width;
    map.height = std::max(1, int(std::lround(double(width) * screen.height_px / screen.width_px)));
    map.density.assign(std::size_t(map.width) * std::size_t(map.height), 0);
    double const cell_x = double(screen.width_px) / map.width, cell_y = double(screen.height_px) / map.height;
    std::vector<std::array<double, 3>> directions;
    directions.reserve(map.density.size());
    for (int y = 0; y < map.height; ++y)
        for (int x = 0; x < map.width; ++x)
            directions.push_back(direction_of_place(screen, {(x + 0.5) * cell_x - 0.5 * screen.width_px,
                                                             (y + 0.5) * cell_y - 0.5 * screen.height_px}));
    double const degree = std::numbers::pi / 180, sd = sd_deg * degree;
    double const least_cosine = std::cos(std::min(5 * sd, std::numbers::pi));
    for (HeatSource const& s : sources) {
        if (std::abs(s.x_px) > 0.5 * screen.width_px || std::abs(s.y_px) > 0.5 * screen.height_px)
            map.outside += s.seconds;
        auto const to = direction_of_place(screen, {s.x_px, s.y_px});
        double const peak = s.seconds / (2 * std::numbers::pi * sd_deg * sd_deg);
        for (std::size_t i = 0; i < directions.size(); ++i) {
            auto const& d = directions[i];
            double const cosine = d[0] * to[0] + d[1] * to[1] + d[2] * to[2];
            if (cosine < least_cosine) continue;
            // The chord keeps small angles exact.
            double const half = 0.5 * std::hypot(d[0] - to[0], d[1] - to[1], d[2] - to[2]);
            double const angle = 2 * std::asin(std::min(1.0, half)) / sd;
            map.density[i] += peak * std::exp(-0.5 * angle * angle);
        }
    }
    map.most = map.density.empty() ? 0 : *std::max_element(map.density.begin(), map.density.end());
    return map;
}

std::array<unsigned char, 3> heat_color(double share)
{
    double const v = std::sqrt(std::clamp(share, 0.0, 1.0));
    std::array<unsigned char, 3> rgb{};
    for (int c = 0; c < 3; ++c)
        rgb[std::size_t(c)] = static_cast<unsigned char>(std::lround(255 * std::clamp(3 * v - c, 0.0, 1.0)));
    return rgb;
}

std::vector<unsigned char> heat_colors(HeatMap const& map, double most)
{
    std::vector<unsigned char> bytes;
    bytes.reserve(4 * map.density.size());
    for (double const density : map.density) {
        auto const rgb = heat_color(density / most);
        bytes.insert(bytes.end(), rgb.begin(), rgb.end());
        bytes.push_back(static_cast<unsigned char>(std::lround(220 * std::clamp(4 * density / most, 0.0, 1.0))));
    }
    return bytes;
}

} // namespace study
