#pragma once
// Grid that warps a picture for a surface that is not flat or not viewed straight: the pixel at `picture` in the
// wall's picture goes to `place` in its viewport. Both count from the lower left corner, 0 to 1.
//
// Nodes are stored row by row from below, each row from the left: node (i, j) is nodes[j * columns + i].
// Each cell is two triangles that share the diagonal from its lower left to its upper right node,
// with linear interpolation within each.

#include "gi/core/math.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace viewer {

struct WarpNode {
    glm::dvec2 place{0}, picture{0};
    double weight = 1; ///< factor on light, 0 to 1

    bool operator==(WarpNode const&) const = default;
};

struct WallMesh {
    int columns = 0, rows = 0; ///< nodes, at least 2 each
    std::vector<WarpNode> nodes;

    WarpNode const& node(int i, int j) const
    {
        return nodes[std::size_t(j) * std::size_t(columns) + std::size_t(i)];
    }
    bool operator==(WallMesh const&) const = default;
};

inline constexpr int kMostWarpNodes = 257; ///< along one side

/// Triangles that draw nothing, and those turned against most others, which draw a part twice.
struct MeshFlaws {
    std::size_t flat = 0, folded = 0;
    glm::ivec2 first_flat{}, first_fold{}; ///< cells

    bool operator==(MeshFlaws const&) const = default;
};
MeshFlaws find_flaws(WallMesh const& mesh);

/// Description of the first invalid cell; none if the mesh can be drawn. All triangles must have the same
/// orientation (mirrored is allowed, folded is not) and area, and lie no farther outside the viewport than its
/// size; `picture` must be within the picture. Meshes of 1000 triangles and more, which come from calibrations,
/// may have up to half flat and 1 in 100 folded. Overlaps of distant triangles are not checked.
std::optional<std::string> find_fault(WallMesh const& mesh);
} // namespace viewer
