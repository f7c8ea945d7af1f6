#pragma once
// What the plan of a scene chooses for the method slhb, where nothing was asked for, and why.

#include "gi/raster/triangle_soup.h"
#include "gi/render/render_settings.h"
#include "gi/scene/model/camera.h"
#include "gi/scene/model/plan.h"

namespace gi {

/// Every number of SlhbSettings chosen. Throws InputError on values that cannot work together.
SlhbSettings choose_settings(RenderSettings const& asked, World const& world, TriangleSoup const& soup,
                             Camera const& camera);

/// The same for frames that follow each other: the budget is that of a frame, and does not build what lasts.
SlhbSettings choose_frame_settings(RenderSettings const& asked, World const& world, TriangleSoup const& soup,
                                   Camera const& camera);

/// Chosen settings as options of the command line, which repeat the picture.
std::string as_options(SlhbSettings const& chosen);

/// What choose_settings decides for a scene and why, as lines of the plan.
std::vector<PlanItem> explain_settings(RenderSettings const& asked, World const& world, Camera const& camera);

/// Whether some path of the scene has to continue with an exact ray, or the camera needs them (orthographic ones
/// have no raster yet).
bool needs_exact_rays(World const& world, bool orthographic, SlhbSettings const& chosen);

} // namespace gi
