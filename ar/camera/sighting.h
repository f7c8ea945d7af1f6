#pragma once
// Output of marker detectors and input of pose estimation: world points and their pixel positions.

#include <glm/glm.hpp>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace ar {

struct SightedPoint {
    glm::dvec3 world_m;    ///< on the marker, in the world's frame
    glm::dvec2 pixel;      ///< in the original (distorted) picture; pixel centres are integers
    int marker = 0;        ///< same number for all points of a marker (or board): outliers affect whole markers
    double sigma_px = 0.1; ///< standard deviation of the detector's error
};

/// The points of known position that were found in one picture.
struct Sighting {
    std::vector<SightedPoint> points;
    int markers_seen = 0;        ///< that the map of the world knows
    int markers_unknown = 0;     ///< seen, but not in the map
    int markers_ambiguous = 0;   ///< left out: their identifier is in the picture more than once
    int candidates_rejected = 0; ///< squares without a code that is known
    /// Of the unknown and of the ambiguous ones, each once: "marker 7 of DICT_4X4_50".
    std::vector<std::string> unknown, ambiguous;
    std::map<std::string, std::set<int>> ids; ///< all identifiers that were seen, by dictionary
    /// Boards and grids left out, since the picture contradicts the map: problem and remedy of each.
    std::vector<std::string> contradictions;
};

} // namespace ar
