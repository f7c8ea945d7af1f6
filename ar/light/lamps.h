#pragma once
// Sun and lamps of an environment as lights of their own, so that they are sampled and throw sharp shadows.
//
// A lamp is a connected region of texels many times brighter than the mean. (Median cut, Debevec 2005, gives every
// part of the sky to some light: good for drawing an environment with few lights alone. Here the rest stays a map,
// and what is cut out should be what people would call a lamp: hence regions.)

#include "ar/light/lat_long.h"

#include <vector>

namespace ar {

struct LampSettings {
    double times_mean = 12;     ///< luminance of a lamp's texels over the mean radiance of the sphere, at least
    std::size_t most = 16;      ///< the strongest are kept
    double least_share = 0.005; ///< of the environment's whole light: fainter ones stay in the map
    double largest_sr = 0.5;    ///< larger regions stay in the map: windows, bright skies
};

struct Lamp {
    glm::dvec3 direction{0, 1, 0}; ///< towards it, mean by light
    /// (integral of L)^2 / integral of L^2 over its region: that of the disc if it is one, and of the core of what
    /// has a soft surround, so that its shadows are as sharp as they should be.
    double solid_angle_sr = 0;
    double half_angle_rad = 0; ///< of the disc of that solid angle
    cv::Vec3d irradiance;      ///< of a face turned to it: its light above what stays in the map, W/m^2
    cv::Vec3d radiance;        ///< of the disc: irradiance over solid angle
};

struct SplitMap {
    cv::Mat rest;            ///< the map without lamps: their texels are filled from around them
    std::vector<Lamp> lamps; ///< strongest first
    int too_faint = 0;       ///< regions left in the map, by the settings
    int too_many = 0;
    int too_large = 0;
    double lamp_share = 0; ///< of the environment's luminance
};

/// Light is conserved in each channel: integral(rest) + sum of irradiance = integral(map).
SplitMap split_lamps(cv::Mat const& map, LampSettings const& settings = {});

/// 0.2126 R + 0.7152 G + 0.0722 B.
double luminance(cv::Vec3d const& rgb);

} // namespace ar
