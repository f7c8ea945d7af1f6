#pragma once
// Settings of the methods vpl_*.

#include <algorithm>
#include <cmath>

namespace gi {

/// Maximum number of points in an imperfect shadow map.
inline constexpr int kMostPoints = 1 << 17;

/// Settings of the methods vpl_*.
struct VirtualLightSettings {
    int light_paths = 256;     ///< light paths per pass; each surface point that one hits becomes a virtual light
    float near_m = 0;          ///< virtual lights nearer than about this are bounded, and camera paths add the
                               ///< rest; 0 = 2 % of the scene's radius
    int points = 1024;         ///< drawn into each imperfect shadow map
    double points_percent = 0; ///< if > 0: the points, as a share of the map's texels, %
    int point_map = 64;        ///< texels per side of an imperfect shadow map
    float ao_radius_m = 0.5f;  ///< ambient and directional occlusion ignore surfaces farther away

    int points_per_map() const
    {
        double const share = std::round(points_percent / 100 * point_map * point_map);
        return points_percent > 0 ? int(std::clamp(share, 0.0, 1e9)) : points;
    }
};

} // namespace gi
