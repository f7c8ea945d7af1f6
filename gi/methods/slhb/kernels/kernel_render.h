#pragma once
// The method slhb as kernels: hit buffers, shadow maps, G-buffer and paths are all computed in one space, and
// only the paths' results are copied back. On the device this is `--device cuda`; on the host it lets tests
// compare it with render_slhb.

#include "gi/render/render_settings.h"
#include "gi/scene/model/world.h"

namespace gi {

/// See RenderFunction in gi/methods. Throws InputError on unsupported features, see check_kernels_can.
RenderResult render_by_kernels(Space space, World const& world, Camera const& camera,
                               RenderSettings const& settings, StopRequest const& stop,
                               RenderProgress const& progress, Report& report);

} // namespace gi
