#pragma once
// Options of light paths and photons.

#include "gi/render/render_option.h"

namespace gi {

RenderOptionTable const& photon_options();

} // namespace gi
