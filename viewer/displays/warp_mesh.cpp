#include "viewer/displays/warp_mesh.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace viewer {
namespace {

constexpr double kLeastArea = 1e-12;          ///< of a triangle, as a share of the viewport
constexpr double kLeastCalibratedArea = 1e-7; ///< less than a fifth of a pixel of a projector
constexpr std::size_t kCalibrated = 1000;     ///< triangles of a mesh that nobody wrote by hand

double twice_area(glm::dvec2 a, glm::dvec2 b, glm::dvec2 c)
{
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

std::size_t triangle_count(WallMesh const& m)
{
    return 2 * std::size_t(std::max(m.columns - 1, 0)) * std::size_t(std::max(m.rows - 1, 0));
}

bool is_within(glm::dvec2 p, double low, double high) // false for NaN
{
    return p.x >= low && p.x <= high && p.y >= low && p.y <= high;
}

/// Each triangle of a cell, lower one first.
std::array<std::array<WarpNode const*, 3>, 2> triangles(WallMesh const& m, int i, int j)
{
    WarpNode const &ll = m.node(i, j), &lr = m.node(i + 1, j), &ur = m.node(i + 1, j + 1), &ul = m.node(i, j + 1);
    return {{{&ll, &lr, &ur}, {&ll, &ur, &ul}}};
}

} // namespace

std::optional<std::string> find_fault(WallMesh const& m)
{
    if (m.columns < 2 || m.rows < 2 || m.columns > kMostWarpNodes || m.rows > kMostWarpNodes)
        return fmt::format("a mesh has 2 to {} columns and rows of nodes, this one {} and {}", kMostWarpNodes,
                           m.columns, m.rows);
    if (m.nodes.size() != std::size_t(m.columns) * std::size_t(m.rows))
        return fmt::format("{} columns and {} rows need {} nodes, there are {}", m.columns, m.rows,
                           m.columns * m.rows, m.nodes.size());
    for (std::size_t n = 0; n < m.nodes.size(); ++n) {
        if (!is_within(m.nodes[n].place, -1, 2))
            return fmt::format("node {} is farther outside the viewport than its size", n);
        if (!is_within(m.nodes[n].picture, 0, 1)) return fmt::format("node {} is outside the picture", n);
        if (!(m.nodes[n].weight >= 0 && m.nodes[n].weight <= 1))
            return fmt::format("node {} has a weight outside 0 to 1", n);
    }
    MeshFlaws const flaws = find_flaws(m);
    std::size_t const count = triangle_count(m);
    // Calibration tools leave such cells where a projector lights nothing, and a seam at the far side of a mirror.
    bool const is_calibrated = count >= kCalibrated;
    if (flaws.flat > (is_calibrated ? count / 2 : 0))
        return fmt::format("cell {} of row {} is flat: three of its nodes lie on a line", flaws.first_flat.x,
                           flaws.first_flat.y);
    if (flaws.folded > (is_calibrated ? count / 100 : 0))
        return fmt::format("the mesh folds at cell {} of row {}: this part would be drawn twice",
                           flaws.first_fold.x, flaws.first_fold.y);
    return {};
}

MeshFlaws find_flaws(WallMesh const& m)
{
    MeshFlaws flaws;
    std::size_t left = 0, right = 0;
    glm::ivec2 first_left{}, first_right{};
    double const least = triangle_count(m) >= kCalibrated ? kLeastCalibratedArea : kLeastArea;
    for (int j = 0; j + 1 < m.rows; ++j)
        for (int i = 0; i + 1 < m.columns; ++i)
            for (auto const& t : triangles(m, i, j)) {
                double const area = twice_area(t[0]->place, t[1]->place, t[2]->place);
                if (std::abs(area) < least) {
                    if (flaws.flat++ == 0) flaws.first_flat = {i, j};
                } else if (area > 0) {
                    if (left++ == 0) first_left = {i, j};
                } else if (right++ == 0)
                    first_right = {i, j};
            }
    bool const is_mirrored = right > left;
    flaws.folded = is_mirrored ? left : right;
    flaws.first_fold = is_mirrored ? first_left : first_right;
    return flaws;
}

} // namespace viewer
