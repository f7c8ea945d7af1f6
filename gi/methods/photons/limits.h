#pragma once
// What the options choose for lattices.

#include "gi/methods/photons/light_propagation.h"
#include "gi/methods/photons/photon_lattice.h"
#include "gi/render/render_settings.h"

namespace gi {

/// Of lpv.
PropagationSettings propagation_of(PhotonSettings const& settings);
/// Of isllpm.
PhotonLatticeSettings lattices_of(PhotonSettings const& settings);
/// Of the light gathering volume of multi_image.
PhotonLatticeSettings volume_of(PhotonSettings const& settings);

} // namespace gi
