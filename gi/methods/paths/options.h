#pragma once
#include "gi/methods/paths/settings.h"
#include "gi/render/render_option.h"

namespace gi {

/// Options of all methods whose paths start at the camera.
RenderOptionTable const& paths_options();

} // namespace gi
