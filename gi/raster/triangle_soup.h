#pragma once
// Triangle corners as nine arrays, so that a vector register holds one coordinate of several triangles. Indices
// are those of the world's triangles. Followed by one vector of points, so that any triangle can be the first of a
// vector.

#include "gi/scene/model/world.h"

#include <array>

namespace gi {

struct TriangleSoup {
    static constexpr std::size_t kPadding = 16, kChunk = 256;

    std::array<std::vector<float>, 9> corner; ///< [3 * vertex + coordinate][triangle], m
    std::size_t count = 0;                    ///< without the padding
    std::vector<Bounds> chunks;               ///< of kChunk triangles each, to skip what a view cannot see

    vec3 vertex(std::size_t triangle, std::size_t k) const
    {
        return {corner[3 * k][triangle], corner[3 * k + 1][triangle], corner[3 * k + 2][triangle]};
    }
};

TriangleSoup make_soup(World const& world);
/// Reads triangles first.. of the world again, which have moved.
void update_soup(World const& world, std::size_t first, TriangleSoup& soup);

} // namespace gi
