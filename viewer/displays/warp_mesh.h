#pragma once
// A grid that bends a picture onto a surface that is not flat or not seen straight: what is drawn at `picture` in
// the wall's picture goes to `place` in its viewport. Both count from the lower left corner, 0 to 1.
//
// Nodes are stored row by row from below, each row from the left: node (i, j) is nodes[j * columns + i]. Every
// cell is two triangles that share the diagonal from its lower left to its upper right node; within them all is
// linear.

#include "gi/core/math.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace viewer {

struct WarpNode {
    glm::dvec2 place{0}, picture{0};

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

/// Which cell is wrong, and how; nothing where the mesh can be drawn. Triangles must all turn the same way
/// (mirrored is fine, folded is not), have area, and lie within one picture of the viewport; `picture` within the
/// picture. That no two triangles far apart overlap is not looked at.
std::optional<std::string> find_fault(WallMesh const& mesh);
} // namespace viewer
