#include "gi/methods/photons/limits.h"

#include "gi/core/error.h"
#include "gi/light_paths/impostors.h"

#include <fmt/format.h>

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
    return {.cells = {s.low_cells, s.middle_cells, s.high_cells},
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

void check_bytes(std::uint64_t bytes, std::string_view what, std::string_view instead)
{
    if (bytes > kMostBytes)
        throw InputError(fmt::format("{} of {:.1f} GiB", what, double(bytes) / double(1 << 30)),
                         fmt::format("at most {} GiB are supported", kMostBytes >> 30), std::string(instead));
}

void check_impostors(PhotonSettings const& settings, bool moves)
{
    check_bytes(impostor_bytes(settings.impostors, settings.impostor_texels, moves), "distance impostors",
                "choose fewer --impostors or --impostor-texels");
}

} // namespace gi
