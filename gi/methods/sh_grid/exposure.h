#pragma once
// Which parts of surfaces light can reach. Only these count as the area that photons spread over: not the foot of
// a column in its floor, a doubled wall, or the inside of something closed.

#include "gi/methods/sh_grid/patches.h"
#include "gi/methods/sh_grid/photons.h"
#include "gi/render/exact_visibility.h"
#include "gi/render/render_settings.h"

#include <array>

namespace gi {

/// What a few rays from the two sides of pieces of surfaces meet. It depends on geometry alone.
struct Surroundings {
    static constexpr std::size_t kRays = 3; ///< per side, cosine-distributed
    static constexpr std::uint32_t
        kNear = 0xffffffffu,          ///< something nearer than a cell: a gap, a fold, what lies on it
        kSky = 0xfffffffeu,           ///< nothing in the grid
        kMirrorOrGlass = 0xfffffffdu; ///< a surface that passes light on
    /// 16 x cell + ReachedSides::side_index() of the side that is met, or one of the above.
    using OfPiece = std::array<std::array<std::uint32_t, kRays>, 2>;

    std::vector<OfPiece> of_piece;
};

/// Appends what the rays of pieces first, first + 1, ... meet. Throws Interrupted.
void look_around(World const& world, ExactVisibility const& visibility, VoxelGrid const& grid, std::size_t first,
                 RayWorld met, BuildStop const& stop, Surroundings& out);

/// Areas of the surfaces in a cell that light can reach, each side by itself, m^2.
using CellArea = AxisBins<float>;

/// Areas that light can reach.
struct ExposedAreas {
    std::vector<CellArea> of_cell;              ///< by index in grid.blocks
    std::vector<std::array<float, 2>> of_patch; ///< front, back; m^2
    double hidden_m2 = 0;                       ///< left out, of both sides
};

/// Areas of the pieces of which a ray met a side that light has reached, mirrors or glass, or a sky that shines.
/// @param lit  per patch, front and back: photons hit it, so that all of it is exposed if rays say none is
ExposedAreas exposed_areas(VoxelGrid const& grid, Patches const& patches, Surroundings const& surroundings,
                           ReachedSides const& reached, std::span<std::uint8_t const> lit, bool sky_shines,
                           RadianceBy by);

} // namespace gi
