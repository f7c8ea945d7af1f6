#pragma once
// The method slhb: global illumination through spherical layered hit buffers (Yu 2012, ch. 5).

#include "gi/render/render_settings.h"
#include "gi/scene/model/world.h"

namespace gi {

/// See RenderFunction in gi/methods. Throws InputError on incompatible settings.
RenderResult render_slhb(World const& world, Camera const& camera, RenderSettings const& settings,
                         StopRequest const& stop, RenderProgress const& progress, Report& report);

} // namespace gi
