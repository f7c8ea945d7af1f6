#pragma once
// Extracts the sun and lamps of an environment map as separate lights, so that they
// are sampled and cast sharp shadows.
//
// A lamp is a connected region of texels many times brighter than the mean. (Median cut, Debevec 2005, assigns
// every part of the sky to some light, which suits rendering with a few lights only. Here the rest remains a map,
// and only actual lamps should be cut out: hence regions.)

#include "ar/light/lat_long.h"

#include <vector>

namespace ar {

struct LampSettings {
    double times_mean = 12;     ///< minimum luminance of a lamp's texels, relative to the sphere's mean radiance
    std::size_t most = 16;      ///< maximum number of lamps; the strongest are kept
    double least_share = 0.005; ///< share of the environment's total light; fainter regions stay in the map
    double largest_sr = 0.5;    ///< larger regions stay in the map: windows, bright skies
};

struct Lamp {
    glm::dvec3 direction{0, 1, 0}; ///< towards the lamp, weighted by light
    /// (integral of L)^2 / integral of L^2 over its region: the exact solid angle for a uniform disc, and that of
    /// the core for a lamp with a soft surround, so that shadows have the right sharpness.
    double solid_angle_sr = 0;
    double half_angle_rad = 0; ///< of a disc with that solid angle
    cv::Vec3d irradiance;      ///< of a face turned to the lamp, without the light left in the map, W/m^2
    cv::Vec3d radiance;        ///< of the disc: irradiance over solid angle
};

struct SplitMap {
    cv::Mat rest;            ///< the map without lamps; their texels are filled from the surrounding ones
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
