#include "gi/methods/sh_grid/radiance_kernels.h"

#include "gi/kernel/launch.h"

namespace gi {
namespace {

SparseCells<CellLight> coarser(SparseCells<CellLight> const& fine)
{
    GridFrame frame = fine.frame;
    frame.cell *= 2;
    frame.size = (frame.size + 1) / 2;
    SparseCells<CellLight> out(frame);
    for (std::size_t k = 0; k < fine.values.size(); ++k)
        out.at(fine.frame.cell_of(fine.cells[k]) / 2) += fine.values[k];
    return out;
}

} // namespace

RadianceGrids make_radiance_grids(SparseCells<BlockVoxels> const& blocks, Patches const& patches,
                                  ExposedAreas const& areas, std::span<ReflectedPhoton const> photons,
                                  SortedPhotons const& sorted, RadianceBy by)
{
    std::size_t const cells = blocks.values.size();
    RadianceGrids grids;
    grids.patches.resize(patches.count());
    for (std::size_t k = 0; k < grids.patches.size(); ++k)
        for (std::size_t side = 0; side < 2; ++side) grids.patches[k].area[side] = areas.of_patch[k][side];
    SparseCells<CellLight> finest(blocks.frame);
    finest.place = blocks.place;
    finest.cells = blocks.cells;
    finest.values.resize(cells);
    launch(Space::host, "sum photons", cells,
           SumPhotons{.photons = {photons.data(), photons.size()},
                      .order = sorted.order,
                      .firsts = sorted.firsts,
                      .first_patch = {patches.fixed.first_patch, patches.moving.first_patch},
                      .areas = areas.of_cell,
                      .by = by,
                      .patches = grids.patches,
                      .cells = finest.values});
    for (std::size_t k = sorted.firsts.back(); k < photons.size(); ++k)
        grids.lost += dvec3(photons[sorted.order[k]].flux);
    grids.levels.push_back(std::move(finest));
    while (max_component(vec3(grids.levels.back().frame.size)) > 1)
        grids.levels.push_back(coarser(grids.levels.back()));
    return grids;
}

dvec3 RadianceGrids::flux() const
{
    dvec3 sum{0};
    for (CellLight const& light : levels[0].values)
        for (vec3 const f : light.flux.bin) sum += dvec3(f);
    return sum;
}

} // namespace gi
