#pragma once
// What detectors find and poses are made of: points of the world and where a picture shows them.

#include <glm/glm.hpp>
#include <string>
#include <vector>

namespace ar {

struct SightedPoint {
    glm::dvec3 world_m; ///< on the marker, in the world's frame
    glm::dvec2 pixel;   ///< in the picture as it came (not undistorted); centres of pixels are whole numbers
    int marker = 0;     ///< points of one marker (or board) have the same number: outliers come marker by marker
    double sigma_px = 0.1; ///< how far the detector is usually off
};

/// Of one picture.
struct Sighting {
    std::vector<SightedPoint> points;
    int markers_seen = 0;        ///< that the map of the world knows
    int markers_unknown = 0;     ///< seen, but not in the map
    int markers_ambiguous = 0;   ///< left out: their identifier is in the picture more than once
    int candidates_rejected = 0; ///< squares without a code that is known
};

} // namespace ar
