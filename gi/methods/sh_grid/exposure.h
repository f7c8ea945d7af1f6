#pragma once
// Which parts of surfaces light can reach. Only these count as the area that photons spread over: not the foot of
// a column in its floor, a doubled wall, or the inside of something closed.

#include "gi/methods/sh_grid/patches.h"
#include "gi/methods/sh_grid/photons.h"
#include "gi/methods/sh_grid/settings.h"
#include "gi/render/exact_visibility.h"
#include "gi/render/render_settings.h"

#include <array>

namespace gi {

/// A sample of a patch, which represents a part of it, and what a few rays from its two sides hit.
struct PatchSample {
    static constexpr std::size_t kRays = 3; ///< per side, cosine-distributed
    static constexpr std::uint32_t
        kNear = 0xffffffffu,          ///< something nearer than a cell: a gap, a fold, what lies on it
        kSky = 0xfffffffeu,           ///< nothing in the grid
        kMirrorOrGlass = 0xfffffffdu; ///< a surface that passes light on

    std::uint32_t patch, triangle;
    vec3 point, normal; ///< of the piece
    float area;         ///< of the part, m^2
    /// 16 x cell + ReachedSides::side_index() of the side that is hit, or one of the above.
    std::array<std::array<std::uint32_t, kRays>, 2> met;
};

/// Appends samples of patches: all pieces of a patch with few, else some, each for an equal part of the area.
/// @param patch_of  patch of each piece
void choose_samples(std::span<SurfacePiece const> pieces, std::span<std::uint32_t const> patch_of,
                    std::vector<PatchSample>& out);

/// Sends the rays of samples; their answers depend on geometry alone. Throws Interrupted.
void look_around(World const& world, ExactVisibility const& visibility, GridFrame const& frame, RayWorld met,
                 BuildStop const& stop, std::span<PatchSample> samples);

/// Areas of the surfaces in a cell that light can reach, each side by itself, m^2.
using CellArea = AxisBins<float>;

/// Areas that light can reach.
struct ExposedAreas {
    std::vector<CellArea> of_cell;              ///< by index of the grid's values
    std::vector<std::array<float, 2>> of_patch; ///< front, back; m^2
    double hidden_m2 = 0;                       ///< left out, of both sides
};

/// Areas of the samples of which a ray met a side that light has reached, mirrors or glass, or a sky that shines;
/// more if photons show a larger lit share of a patch.
ExposedAreas exposed_areas(SparseCells<BlockVoxels> const& blocks, Patches const& patches,
                           std::span<PatchSample const> samples, ReachedSides const& reached,
                           std::span<ReflectedPhoton const> photons, SortedPhotons const& sorted, bool sky_shines,
                           RadianceBy by);

} // namespace gi
