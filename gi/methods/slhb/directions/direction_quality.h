#pragma once
// How evenly a set of directions covers the sphere, and how far its map is from the truth.

#include "gi/methods/slhb/directions/direction_map.h"

namespace gi {

/// Solid angle nearer to each axis' direction than to any other, sr, by counting `samples` points of a Fibonacci
/// lattice. One value per axis; their sum is 2 pi.
std::vector<double> solid_angles(DirectionSet const& directions, std::size_t samples);

struct DirectionQuality {
    double largest_gap_rad = 0, mean_gap_rad = 0; ///< angle from a point of the sphere to the nearest direction
    double smallest_solid_angle = 0, largest_solid_angle = 0; ///< relative to 4 pi / size
    double solid_angle_deviation = 0;                         ///< standard deviation, relative
};
DirectionQuality measure(DirectionSet const& directions, std::size_t samples);

struct MapQuality {
    double wrong_share = 0;        ///< of directions whose answer is not the nearest
    double largest_excess_rad = 0; ///< by how much the answer is farther than the nearest at most
    double mean_excess_rad = 0;
};
MapQuality measure(DirectionMapView const& map, DirectionSet const& directions, std::size_t samples);

} // namespace gi
