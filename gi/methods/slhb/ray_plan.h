#pragma once
// Chooses between look-ups and exact rays, for surfaces and for shadows.

#include "gi/methods/slhb/tracer/costs.h"
#include "gi/raster/triangle_soup.h"
#include "gi/render/render_settings.h"
#include "gi/scene/model/camera.h"
#include "gi/scene/model/plan_text.h"

namespace gi {

/// Look-ups are cheaper than rays, but pixels share their error: at equal time, exact rays leave less visible
/// error, and far less after a filter (docs/decisions/look-ups-on-cpu.md). So look-ups are used on request, or
/// if building a BVH would take too much of the budget and look-ups are accurate enough.
struct RayPlan {
    LookUps look_ups = LookUps::none;
    Shadows shadows = Shadows::rays;
    PlanText why_look_ups = "", why_shadows = "";
};

/// @param resolution  texels per side that a hit buffer would have
/// @param lasting   structures serve many pictures, so that their build time is ignored
RayPlan plan_rays(RenderSettings const& asked, int resolution, World const& world, TriangleSoup const& soup,
                  Camera const& camera, Costs const& costs, bool lasting);

/// Returns the number of paths per pixel that the budget allows with exact rays, at least 1.
double expected_passes(RenderSettings const& asked, Costs const& costs);

/// True if some path may have to continue with an exact ray: some lobe is narrow, a mirror or glass.
bool narrow_somewhere(World const& world);
/// True if some surface is a mirror or glass. These do not count as bounces: paths reach lights through them.
bool smooth_somewhere(World const& world);

} // namespace gi
