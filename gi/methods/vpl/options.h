#pragma once
#include "gi/render/render_option.h"

namespace gi {

/// Options of the methods vpl_*; vpl_slhb reads some of slhb, too.
RenderOptionTable const& virtual_light_options();

} // namespace gi
