#include "gi/methods/photons/limits.h"

#include "gi/core/error.h"
#include "gi/light_paths/impostor_maps.h"

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

PhotonLatticeSettings volume_of(PhotonSettings const& s) { return {.cells = {s.volume_cells, s.volume_cells, 4}}; }

std::uint32_t impostor_resolution(PhotonSettings const& s)
{
    constexpr int kBlock = ImpostorsView::kBlock;
    return std::uint32_t((s.impostor_texels + kBlock - 1) / kBlock * kBlock);
}

std::uint64_t impostor_bytes(PhotonSettings const& s, bool moves)
{
    std::uint64_t const side = impostor_resolution(s), texels = std::uint64_t(s.impostors) * 6 * side * side;
    return texels * sizeof(ImpostorTexel) * (moves ? 2 : 1) +
           texels / (ImpostorsView::kBlock * ImpostorsView::kBlock) * sizeof(ImpostorBlock);
}

void check_bytes(std::uint64_t bytes, std::string_view what, std::string_view instead)
{
    if (bytes > kMostBytes)
        throw InputError(fmt::format("{} of {:.1f} GiB", what, double(bytes) / double(1 << 30)),
                         fmt::format("at most {} GiB are supported", kMostBytes >> 30), std::string(instead));
}

void check_impostors(PhotonSettings const& settings, bool moves)
{
    check_bytes(impostor_bytes(settings, moves), "distance impostors",
                "choose fewer --impostors or --impostor-texels");
}

} // namespace gi
