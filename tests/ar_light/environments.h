#pragma once
// Surrounds that the tests know: as functions of direction, and drawn as maps.

#include "ar/light/lat_long.h"

#include <cmath>
#include <functional>

namespace ar::test {

using Environment = std::function<cv::Vec3d(glm::dvec3)>;

/// The mean of n x n samples per texel.
inline cv::Mat drawn(cv::Size size, Environment const& light, int n = 3)
{
    cv::Mat map(size, CV_32FC3);
    for (int j = 0; j < size.height; ++j)
        for (int i = 0; i < size.width; ++i) {
            cv::Vec3d sum(0, 0, 0);
            for (int b = 0; b < n; ++b)
                for (int a = 0; a < n; ++a)
                    sum += light(
                        direction_of_uv({(i + (a + 0.5) / n) / size.width, (j + (b + 0.5) / n) / size.height}));
            map.at<cv::Vec3f>(j, i) = cv::Vec3f(sum / (n * n));
        }
    return map;
}

/// Walls of slowly changing colour and a ceiling.
inline cv::Vec3d room(glm::dvec3 d)
{
    double const wall = 0.6 + 0.3 * std::sin(3 * d.x + 1) * std::cos(2 * d.z);
    return {wall * (1 + 0.3 * d.y), wall, wall * (1 - 0.3 * d.y + 0.2 * d.x)};
}
inline Environment const kRoom = room;

struct Disc {
    glm::dvec3 direction;
    double half_angle_rad;
    double radiance;
};
/// `base` with lamps on it, white.
inline Environment with_discs(Environment base, std::vector<Disc> discs)
{
    return [base = std::move(base), discs = std::move(discs)](glm::dvec3 d) {
        cv::Vec3d light = base(d);
        for (Disc const& s : discs)
            if (glm::dot(glm::normalize(s.direction), d) > std::cos(s.half_angle_rad))
                light += cv::Vec3d::all(s.radiance);
        return light;
    };
}

} // namespace ar::test
