#pragma once
// Light that leaves the surfaces in the cells of a grid (Chang, Park and Ihm, sec. 3.3),
// and coarser grids of it (R-grid).
//
// The flux of photons is divided among six directions along the axes, by the squares of a direction's components;
// divided by pi times the surfaces' exposed area, divided in the same way, it is a radiance.
// The direction is the surface's normal, or, as in the paper, that in which the photon leaves:
// then areas count by the mean of the squares over their cosine lobes, (1 + n . e)^2 / 8.
// (The paper divides by the area of the cell's face, and scales by the cosine when it reads:
// up to twice too dark for a wall along the grid. And the two sides of a thin wall mix.)

#include "gi/methods/sh_grid/exposure.h"

namespace gi {

struct CellLight {
    AxisBins<vec3> flux; ///< W
    CellArea area;

    GI_FN CellLight& operator+=(CellLight const& o)
    {
        flux += o.flux;
        area += o.area;
        return *this;
    }
};

/// Light that a ray meets in a cell.
struct SeenLight {
    vec3 radiance{0};
    float area = 0; ///< m^2; 0 = only what no light reaches
};

/// Radiance of the surfaces that face a direction. @param towards  unit: the normal that the ray meets; or with
/// RadianceBy::direction that from which it comes, then axes count by a Gaussian of the angle to them
GI_FN inline SeenLight seen_light(CellLight const& of, vec3 towards, RadianceBy by)
{
    constexpr float kWidth = 0.6f; // rad
    SeenLight out;
    for (int axis = 0; axis < 3; ++axis) {
        float const c = glm::abs(towards[axis]);
        float const weight =
            by == RadianceBy::normal ? square(c) : std::exp(-0.5f * square(std::acos(glm::min(c, 1.0f)) / kWidth));
        int const k = 2 * axis + (towards[axis] > 0 ? 1 : 0);
        if (!(of.area.bin[k] > 0)) continue;
        out.radiance += weight * of.flux.bin[k];
        out.area += weight * of.area.bin[k];
    }
    // Less is rounding, of a normal or of areas.
    if (out.area > 1e-3f * of.area.largest())
        out.radiance /= kPi * out.area;
    else
        out = {};
    return out;
}

/// Light of the two sides of a patch, front and back.
struct PatchLight {
    vec3 flux[2] = {};      ///< W
    float area[2] = {0, 0}; ///< m^2

    GI_FN SeenLight seen(std::uint32_t side) const
    {
        if (!(area[side] > 0)) return {};
        return {flux[side] / (kPi * area[side]), area[side]};
    }
};

/// Grids of all levels: each has cells of twice the side of the one before, down to one cell.
struct RadianceGrids {
    std::vector<SparseCells<CellLight>> levels;
    std::vector<PatchLight> patches; ///< of the finest level
    dvec3 lost{0};                   ///< flux of photons outside of the grid, W

    dvec3 flux() const; ///< of the finest level, W
};

/// Grids with the photons' flux: each patch's and cell's summed in their order.
RadianceGrids make_radiance_grids(SparseCells<BlockVoxels> const& blocks, Patches const& patches,
                                  ExposedAreas const& areas, std::span<ReflectedPhoton const> photons,
                                  SortedPhotons const& sorted, RadianceBy by);

} // namespace gi
