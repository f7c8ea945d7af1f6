#pragma once
// What the options choose for lattices and impostors, and how much memory these may take: it is checked before
// any of it is spent.

#include "gi/methods/photons/light_propagation.h"
#include "gi/methods/photons/photon_lattice.h"
#include "gi/render/render_settings.h"

#include <string_view>

namespace gi {

/// Of lpv.
PropagationSettings propagation_of(PhotonSettings const& settings);
/// Of isllpm.
PhotonLatticeSettings lattices_of(PhotonSettings const& settings);
/// Of the light gathering volume of multi_image.
PhotonLatticeSettings volume_of(PhotonSettings const& settings);
inline constexpr std::uint64_t kMostBytes = PhotonLatticeSettings::kMostBytes;
/// Throws InputError for more than kMostBytes. @param what  "lattices"  @param instead  "choose fewer cells"
void check_bytes(std::uint64_t bytes, std::string_view what, std::string_view instead);
void check_impostors(PhotonSettings const& settings, bool moves);

} // namespace gi
