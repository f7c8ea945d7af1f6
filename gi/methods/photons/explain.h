#pragma once
// What the photon methods build for a world, what they do not, and why. See ExplainMethod.

#include "gi/render/render_settings.h"
#include "gi/scene/model/plan.h"

namespace gi {

std::vector<PlanItem> explain_ispm(World const& world, RenderSettings const& settings, Camera const& camera);
std::vector<PlanItem> explain_lpv(World const& world, RenderSettings const& settings, Camera const& camera);
std::vector<PlanItem> explain_isllpm(World const& world, RenderSettings const& settings, Camera const& camera);
std::vector<PlanItem> explain_multi_image(World const& world, RenderSettings const& settings,
                                          Camera const& camera);

} // namespace gi
