#pragma once
// Whether paths look surfaces and shadows up, or send exact rays.

#include "gi/methods/slhb/tracer/costs.h"
#include "gi/raster/triangle_soup.h"
#include "gi/render/render_settings.h"
#include "gi/scene/model/camera.h"

namespace gi {

/// Look-ups are cheaper than rays, but pixels share their error: at equal time exact rays leave less that an
/// observer sees, and far less after a filter (docs/results/2026-11-25-pictures.md). So look-ups are for when they
/// are asked for, and for when a BVH would take too much of the budget, if they can be trusted then.
struct RayPlan {
    LookUps look_ups = LookUps::none;
    Shadows shadows = Shadows::rays;
    std::string why_look_ups, why_shadows;
};

/// @param resolution  texels that a hit buffer would have on a side
/// @param lasting     structures serve many pictures: what they take to build does not count
RayPlan plan_rays(RenderSettings const& asked, int resolution, World const& world, TriangleSoup const& soup,
                  Camera const& camera, Costs const& costs, bool lasting);

/// Paths per pixel that there is time for by exact rays, at least 1.
double expected_passes(RenderSettings const& asked, Costs const& costs);

/// Whether some path of the scene has to continue with an exact ray: some lobe is narrow, a mirror or glass.
bool narrow_somewhere(World const& world);
/// Whether some surface is a mirror or glass, which do not count as bounces: paths find lamps through them.
bool smooth_somewhere(World const& world);

} // namespace gi
