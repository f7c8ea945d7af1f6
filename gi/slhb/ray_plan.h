#pragma once
// Whether paths look surfaces and shadows up, or send exact rays: whichever costs less in all, as long as look-ups
// can be trusted.

#include "gi/image/render_settings.h"
#include "gi/raster/triangle_soup.h"
#include "gi/scene/camera.h"
#include "gi/slhb/costs.h"

namespace gi {

struct RayPlan {
    LookUps look_ups = LookUps::all;
    Shadows shadows = Shadows::maps;
    std::string why_look_ups, why_shadows;
};

/// @param chosen  all that look-ups and shadow maps would have  @param asked  before that, which decides where it
///                says something about either
/// @param lasting structures serve many pictures: what they take to build does not count
RayPlan plan_rays(RenderSettings const& asked, SlhbSettings const& chosen, World const& world,
                  TriangleSoup const& soup, Camera const& camera, Costs const& costs, bool lasting);

/// Whether some path of the scene has to continue with an exact ray: some lobe is narrow, a mirror or glass.
bool narrow_somewhere(World const& world);
/// Whether some surface is a mirror or glass, which do not count as bounces: paths find lamps through them.
bool smooth_somewhere(World const& world);

} // namespace gi
