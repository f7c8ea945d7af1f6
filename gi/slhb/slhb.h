#pragma once
// The method slhb: global illumination through spherical layered hit buffers (Yu 2012, ch. 5).

#include "gi/image/render_settings.h"
#include "gi/scene/world.h"

namespace gi {

/// See RenderFunction in gi/registry. Throws InputError on settings that cannot work.
RenderResult render_slhb(World const& world, Camera const& camera, RenderSettings const& settings,
                         StopRequest const& stop, RenderProgress const& progress, Report& report);

} // namespace gi
