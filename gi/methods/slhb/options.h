#pragma once
#include "gi/render/render_option.h"

namespace gi {

/// Options of the method slhb.
RenderOptionTable const& slhb_options();

} // namespace gi
