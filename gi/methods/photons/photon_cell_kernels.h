#pragma once
// A step of the injection of photons, as a kernel for CPU and CUDA.

#include "gi/methods/photons/photon_lattice.h"

namespace gi {

/// The cell of each photon, of those around it the nearest one with exposed area if it has none; and its weight.
struct FindPhotonCells {
    CellsView<PhotonCell> cells; ///< with their areas
    View<vec3 const> positions;
    View<LatticePhoton> photons;
    View<std::uint64_t> keys; ///< index of the cell's value, or kNoCell
    bool beyond = true;       ///< photons beyond the grid belong to cells at its border

    GI_FN void operator()(std::size_t i) const
    {
        glm::ivec3 const at = cells.frame.at(positions[i]);
        keys[i] = kNoCell;
        if (!beyond && !cells.frame.holds(at)) return;
        std::uint32_t best = kNoCell;
        float nearest = 1e30f;
        for (int k = 0; k < 27; ++k) {
            glm::ivec3 const c = at + glm::ivec3{k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1};
            std::uint32_t const place = cells.find_place(c);
            if (place == kNoCell || !(facing_area(cells.values[place], photons[i].normal) > 0)) continue;
            vec3 const outside =
                glm::max(glm::abs(positions[i] - cells.frame.center(c)) - 0.5f * cells.frame.cell, vec3{0});
            float const distance = glm::dot(outside, outside);
            if (c != at && distance >= nearest) continue;
            nearest = c == at ? -1 : distance;
            best = place;
        }
        if (best == kNoCell) return;
        keys[i] = best;
        vec4 const area = cells.values[best].area;
        float const projected =
            0.25f * area.x + 0.5f * glm::dot(vec3(area.y, area.z, area.w), photons[i].direction);
        photons[i].weight = area.x / glm::max(projected, 0.1f * area.x);
    }

private:
    GI_FN static float facing_area(PhotonCell const& cell, vec3 normal)
    {
        float const facing = cell.area.x + glm::dot(vec3(cell.area.y, cell.area.z, cell.area.w), normal);
        return facing > 1e-3f * cell.area.x ? facing : 0;
    }
};

} // namespace gi
