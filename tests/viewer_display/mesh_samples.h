#pragma once
// Warp meshes as their definition says (viewer/displays/warp_mesh.h):
// where a point of the viewport is in the picture.

#include "viewer/displays/warp_mesh.h"

namespace viewer::test {

inline double twice_area(glm::dvec2 a, glm::dvec2 b, glm::dvec2 c)
{
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// Each triangle of a cell, lower one first.
inline std::array<std::array<WarpNode const*, 3>, 2> triangles(WallMesh const& m, int i, int j)
{
    WarpNode const &ll = m.node(i, j), &lr = m.node(i + 1, j), &ur = m.node(i + 1, j + 1), &ul = m.node(i, j + 1);
    return {{{&ll, &lr, &ur}, {&ll, &ur, &ul}}};
}

/// Nodes where they would be without a mesh.
inline WallMesh plain_mesh(int columns, int rows)
{
    WallMesh mesh{columns, rows, {}};
    for (int j = 0; j < rows; ++j)
        for (int i = 0; i < columns; ++i) {
            glm::dvec2 const p{double(i) / (columns - 1), double(j) / (rows - 1)};
            mesh.nodes.push_back({p, p});
        }
    return mesh;
}

/// Where the point of the viewport is in the picture; nothing outside of the mesh.
inline std::optional<glm::dvec2> picture_at(WallMesh const& m, glm::dvec2 p)
{
    for (int j = 0; j + 1 < m.rows; ++j)
        for (int i = 0; i + 1 < m.columns; ++i)
            for (auto const& t : triangles(m, i, j)) {
                double const whole = twice_area(t[0]->place, t[1]->place, t[2]->place);
                double const a = twice_area(p, t[1]->place, t[2]->place) / whole;
                double const b = twice_area(t[0]->place, p, t[2]->place) / whole;
                double const c = 1 - a - b;
                if (a >= -1e-12 && b >= -1e-12 && c >= -1e-12)
                    return a * t[0]->picture + b * t[1]->picture + c * t[2]->picture;
            }
    return {};
}

} // namespace viewer::test
