#pragma once
// The method slhb by kernels: hit buffers, shadow maps, G-buffer and paths are all made in one space, and only the
// paths' results come back. On the device this is `--device cuda`; on the host it is there so that tests can hold
// it to render_slhb.

#include "gi/render/render_settings.h"
#include "gi/scene/model/world.h"

namespace gi {

/// See RenderFunction in gi/methods. What is missing from the picture is in path_kernel.h, and counted in the
/// report. Throws InputError on what kernels cannot do, see check_kernels_can.
RenderResult render_by_kernels(Space space, World const& world, Camera const& camera,
                               RenderSettings const& settings, StopRequest const& stop,
                               RenderProgress const& progress, Report& report);

} // namespace gi
