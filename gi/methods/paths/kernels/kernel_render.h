#pragma once
// The methods slhb and paths as kernels: all that paths need is computed in one space, and only their results are
// copied back. On the device this is `--device cuda`; on the host it lets tests compare it with the forms of the CPU.

#include "gi/render/render_settings.h"
#include "gi/scene/model/world.h"

namespace gi {

/// slhb. See Method; throws InputError on what kernels lack, see KernelRenderer::check.
RenderResult render_by_kernels(Space space, World const& world, Camera const& camera,
                               RenderSettings const& settings, StopRequest const& stop,
                               RenderProgress const& progress, Report& report);
/// paths. The same.
RenderResult render_paths_by_kernels(Space space, World const& world, Camera const& camera,
                                     RenderSettings const& settings, StopRequest const& stop,
                                     RenderProgress const& progress, Report& report);

} // namespace gi
