#include "gi/methods/photons/limits.h"

namespace gi {

PropagationSettings propagation_of(PhotonSettings const& s)
{
    return {.cells = s.propagation_cells,
            .cascades = s.propagation_cascades,
            .steps = s.propagation_steps,
            .by = s.reprojection};
}

PhotonLatticeSettings lattices_of(PhotonSettings const& s)
{
    bool const smooth = s.lattice_smoothing == Switch::on;
    // The lattice of caustics stays empty if kernels show them.
    int const high = s.caustics_by == CausticsBy::kernels ? 4 : s.high_cells;
    return {.cells = {s.low_cells, s.middle_cells, high},
            .smooth = {smooth, smooth, false},
            .cascades = s.lattice_cascades,
            .by = s.irradiance_by};
}

PhotonLatticeSettings volume_of(PhotonSettings const& s)
{
    return {.cells = {s.volume_cells, s.volume_cells, 4},
            .smooth = {false, false, false},
            .gathers = s.volume_gathers,
            .cascades = s.lattice_cascades};
}

} // namespace gi
