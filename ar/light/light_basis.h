#pragma once
// The directions of an estimated environment: points of a Fibonacci lattice on the sphere (Gonzalez 2010).
// Each represents the same solid angle.

#include "ar/light/lat_long.h"

#include <vector>

namespace ar {

class LightBasis {
public:
    /// @param count  of directions, at least 16
    explicit LightBasis(int count);

    int count() const { return int(directions_.size()); }
    glm::dvec3 direction(int k) const { return directions_[std::size_t(k)]; }
    /// Solid angle of each direction's cell, sr.
    double cell_sr() const;
    /// About half the angle between neighbours: radius of a cap of the cell's solid angle.
    double cell_radius_rad() const;
    int nearest(glm::dvec3 direction) const;
    /// Pairs of neighbours, each once: lower number first.
    std::vector<std::pair<int, int>> const& neighbours() const { return neighbours_; }

    /// Lat-long picture of values, one row per direction (CV_32F, any number of channels):
    /// a weighted mean of the directions nearby.
    cv::Mat spread(cv::Mat const& values, cv::Size size) const;

private:
    std::vector<glm::dvec3> directions_;
    std::vector<std::pair<int, int>> neighbours_;
    cv::Mat nearest_; ///< CV_32SC1, lat-long
};

} // namespace ar
