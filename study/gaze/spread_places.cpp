#include "study/gaze/spread_places.h"

#include "study/display/geometry.h"

#include <cmath>
#include <numbers>

namespace study {

std::vector<GazeOffset> gaussian_offsets(double sd_deg, int count)
{
    double const golden = std::numbers::pi * (3 - std::sqrt(5.0));
    std::vector<GazeOffset> offsets;
    for (int i = 0; i < count; ++i)
        offsets.push_back({sd_deg * std::sqrt(-2 * std::log(1 - (i + 0.5) / count)), i * golden});
    return offsets;
}

std::optional<std::pair<double, double>> offset_place(ScreenGeometry const& screen,
                                                      std::pair<double, double> place_px, GazeOffset const& offset)
{
    auto const d = direction_of_place(screen, place_px);
    // Two axes at right angles to it: x turned about y, and their cross product.
    double const flat = std::hypot(d[0], d[2]);
    std::array<double, 3> const right{d[2] / flat, 0, -d[0] / flat};
    std::array<double, 3> const down{d[1] * right[2] - d[2] * right[1], d[2] * right[0] - d[0] * right[2],
                                     d[0] * right[1] - d[1] * right[0]};
    double const angle = offset.deg * std::numbers::pi / 180, away = std::sin(angle);
    std::array<double, 3> to{};
    for (std::size_t a = 0; a < 3; ++a)
        to[a] = std::cos(angle) * d[a] +
                away * (std::cos(offset.around_rad) * right[a] + std::sin(offset.around_rad) * down[a]);
    if (!(to[2] > 1e-6)) return {};
    auto const [across, along] = pixels_per_cm(screen);
    return std::pair{to[0] / to[2] * screen.distance_cm * across, to[1] / to[2] * screen.distance_cm * along};
}

} // namespace study
