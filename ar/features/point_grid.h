#pragma once
// Points in space, found by their distance: a grid for each power of two that a radius was asked for, whose cells
// are at least as large as the radius.

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <map>
#include <unordered_map>
#include <vector>

namespace ar {

class PointGrid {
public:
    /// The point's index is the number of points before it. @param at  finite
    void add(glm::dvec3 const& at);
    void move(std::size_t index, glm::dvec3 const& to);
    /// Indices of all points within `radius` > 0, increasing.
    std::vector<std::size_t> near(glm::dvec3 const& at, double radius);

private:
    using Cell = std::array<std::int64_t, 3>;
    struct Hash {
        std::size_t operator()(Cell const& c) const;
    };
    using Level = std::unordered_map<Cell, std::vector<std::size_t>, Hash>;
    static Cell cell_of(glm::dvec3 const& at, int level);

    std::vector<glm::dvec3> points_;
    std::map<int, Level> levels_; ///< by the exponent of the cell's size
};

} // namespace ar
