#pragma once
// Distance impostors (Szirmay-Kalos et al. 2005): pictures around some points of the scene, as cube maps, whose
// texels hold how far away the nearest surface is and which triangle it is of. Borrowed arrays, for CPU and CUDA.
//
// Faces and texels are those of cube_face() in gi/raster/perspective_grid.h. In memory:
// [impostor][face][block][row of block][column of block], blocks of kBlock^2 texels row by row.

#include "gi/core/view.h"
#include "gi/render/ray_query.h"

namespace gi {

struct alignas(8) ImpostorTexel {
    float distance = kInf; ///< from the centre in the direction of the texel's centre, m; kInf = nothing there
    std::uint32_t triangle = kNoTriangle;
};

/// A texel of a cube map.
struct CubeTexel {
    int face, i, j; ///< column, row
};

/// Least and greatest distance in a block.
struct ImpostorBlock {
    float nearest = kInf, farthest = 0; ///< m; kInf = nothing there
};

struct ImpostorsView {
    static constexpr int kBlock = 8;

    View<vec3 const> centres; ///< m
    View<ImpostorTexel const> texels;
    View<ImpostorBlock const> blocks; ///< in the order of texels
    std::uint32_t resolution = 0;     ///< texels along an edge of a face, a multiple of kBlock

    GI_FN std::uint32_t count() const { return std::uint32_t(centres.size()); }
    /// Width of a texel in the middle of a face, m per m of distance.
    GI_FN float texel_width() const { return 2 / float(resolution); }
    GI_FN int blocks_across() const { return int(resolution) / kBlock; }
    /// Index of the block at (i, j) of a face, in blocks.
    GI_FN std::size_t block(std::uint32_t impostor, int face, int i, int j) const
    {
        auto const n = std::size_t(blocks_across());
        return ((std::size_t(impostor) * 6 + std::size_t(face)) * n + std::size_t(j)) * n + std::size_t(i);
    }
    GI_FN std::size_t index(std::uint32_t impostor, CubeTexel t) const
    {
        return block(impostor, t.face, t.i / kBlock, t.j / kBlock) * kBlock * kBlock +
               std::size_t(t.j % kBlock * kBlock + t.i % kBlock);
    }
    GI_FN ImpostorTexel const& at(std::uint32_t impostor, CubeTexel t) const { return texels[index(impostor, t)]; }
    /// @param direction  of any length but 0
    GI_FN ImpostorTexel const& look(std::uint32_t impostor, vec3 direction) const
    {
        return at(impostor, cube_texel(direction));
    }
    GI_FN CubeTexel cube_texel(vec3 direction) const
    {
        vec3 const size = glm::abs(direction);
        bool const by_x = size.x >= size.y && size.x >= size.z, by_y = !by_x && size.y >= size.z;
        // The axes after that of the face; without indices, which would send the vector through memory.
        float const w = by_x   ? direction.x
                        : by_y ? direction.y
                               : direction.z,
                    u = by_x   ? direction.y
                        : by_y ? direction.z
                               : direction.x,
                    v = by_x   ? direction.z
                        : by_y ? direction.x
                               : direction.y;
        float const scale = 0.5f * float(resolution), along = scale / std::abs(w);
        int const face = (by_x ? 0 : by_y ? 2 : 4) + (w > 0 ? 0 : 1);
        return {face, column(scale + along * u), column(scale + along * v)};
    }
    GI_FN int column(float at) const { return glm::clamp(int(at), 0, int(resolution) - 1); }
};

/// True if an impostor sees a point: at its texels' resolution, nothing nearer lies in the point's direction.
GI_FN inline bool sees(ImpostorsView const& maps, std::uint32_t impostor, vec3 point)
{
    vec3 const to = point - maps.centres[impostor];
    float const squared = glm::dot(to, to);
    if (!(squared > 0)) return true;
    float const nearer = 1 - 2 * maps.texel_width();
    return square(maps.look(impostor, to).distance) >= square(nearer) * squared;
}

inline constexpr std::uint32_t kNoImpostor = 0xffffffffu;

/// The impostor whose centre is nearest to a point; kNoImpostor if there are none.
GI_FN inline std::uint32_t nearest_impostor(ImpostorsView const& maps, vec3 point)
{
    std::uint32_t best = kNoImpostor;
    float least = kInf;
    for (std::uint32_t k = 0; k < maps.count(); ++k) {
        vec3 const to = point - maps.centres[k];
        float const squared = glm::dot(to, to);
        if (squared < least) {
            least = squared;
            best = k;
        }
    }
    return best;
}

/// The nearest impostor that sees the point, excluding `but`; kNoImpostor if there is none.
/// @param side  if the point lies on a surface, its normal on the side from which it is to be seen, of any length
GI_FN inline std::uint32_t nearest_seeing(ImpostorsView const& maps, vec3 point, std::uint32_t but = kNoImpostor,
                                          vec3 side = vec3{0})
{
    std::uint32_t best = kNoImpostor;
    float least = kInf;
    for (std::uint32_t k = 0; k < maps.count(); ++k) {
        vec3 const to = point - maps.centres[k];
        float const squared = glm::dot(to, to);
        if (squared < least && k != but && glm::dot(to, side) <= 0 && sees(maps, k, point)) {
            least = squared;
            best = k;
        }
    }
    return best;
}

} // namespace gi
