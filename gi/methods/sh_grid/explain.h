#pragma once
// What the method sh_grid builds for a world, and why.

#include "gi/render/render_settings.h"
#include "gi/scene/model/plan.h"

namespace gi {

/// Traces a few rays from the camera.
std::vector<PlanItem> explain_sh_grid(World const& world, RenderSettings const& settings, Camera const& camera);

} // namespace gi
