#pragma once
// Seconds of gaze on each triangle of a scene.

#include "gi/scene/model/world.h"

#include <filesystem>
#include <string>
#include <vector>

namespace viewer {

struct SurfaceHeat {
    std::string file, scene;                    ///< file: name without an ending
    gi::dvec3 origin{0};                        ///< of the corners, m, world
    std::vector<gi::vec3> corners;              ///< three of each triangle, m
    std::vector<double> seconds;                ///< by triangle
    double most() const;                        ///< s/m2; triangles without area count as 0
    double density(std::size_t triangle) const; ///< s/m2
};

/// Binary PLY: vertices x, y, z in the world, faces with vertex_indices, seconds, seconds_per_m2 and a colour: grey
/// where nobody looked, from black by red and yellow to white at `most`, by the square root. @throws gi::InputError
void write_heat_ply(std::filesystem::path const& file, SurfaceHeat const& heat);

} // namespace viewer
