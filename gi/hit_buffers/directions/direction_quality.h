#pragma once
// Measures how evenly a set of directions covers the sphere, and the errors of its map.

#include "gi/hit_buffers/directions/direction_map.h"

namespace gi {

/// Solid angle of the points nearest to each axis' direction, sr, estimated by counting `samples` points of a
/// Fibonacci lattice. One value per axis; they sum to 2 pi.
std::vector<double> solid_angles(DirectionSet const& directions, std::size_t samples);

struct DirectionQuality {
    double largest_gap_rad = 0, mean_gap_rad = 0; ///< angle from a point of the sphere to the nearest direction
    double smallest_solid_angle = 0, largest_solid_angle = 0; ///< relative to 4 pi / size
    double solid_angle_deviation = 0;                         ///< standard deviation, relative
};
DirectionQuality measure(DirectionSet const& directions, std::size_t samples);

struct MapQuality {
    double wrong_share = 0; ///< fraction of directions for which the map does not return the nearest
    /// Largest additional angle to the returned direction, compared with the nearest.
    double largest_excess_rad = 0;
    double mean_excess_rad = 0;
};
MapQuality measure(DirectionMapView const& map, DirectionSet const& directions, std::size_t samples);

} // namespace gi
