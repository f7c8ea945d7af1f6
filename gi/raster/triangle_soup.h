#pragma once
// Triangle corners in nine arrays (structure of arrays), so that a SIMD register holds one coordinate of several
// triangles. Indices are those of the world's triangles. The arrays are padded by one SIMD vector of degenerate
// triangles, so that a vector can be loaded from any triangle on.

#include "gi/scene/model/world.h"

#include <array>

namespace gi {

struct TriangleSoup {
    static constexpr std::size_t kPadding = 16, kChunk = 256;

    std::array<std::vector<float>, 9> corner; ///< [3 * vertex + coordinate][triangle], m
    std::size_t count = 0;                    ///< without the padding
    std::vector<Bounds> chunks;               ///< bounds of kChunk triangles each, for culling

    vec3 vertex(std::size_t triangle, std::size_t k) const
    {
        return {corner[3 * k][triangle], corner[3 * k + 1][triangle], corner[3 * k + 2][triangle]};
    }
};

TriangleSoup make_soup(World const& world);
/// Updates the triangles from `first` on, which have moved, from the world.
void update_soup(World const& world, std::size_t first, TriangleSoup& soup);

} // namespace gi
