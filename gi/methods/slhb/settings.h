#pragma once
// How the scene plan chooses the settings of slhb that were not given, and why.

#include "gi/raster/triangle_soup.h"
#include "gi/render/render_option.h"
#include "gi/scene/model/camera.h"
#include "gi/scene/model/plan.h"

namespace gi {

/// Returns settings in which every number is chosen. Throws InputError on incompatible values.
SlhbSettings choose_settings(RenderSettings const& asked, World const& world, TriangleSoup const& soup,
                             Camera const& camera);

/// The same for frame sequences: the budget is per frame and does not include building lasting structures.
SlhbSettings choose_frame_settings(RenderSettings const& asked, World const& world, TriangleSoup const& soup,
                                   Camera const& camera);

/// Options of the method slhb; vpl_slhb reads some.
RenderOptionTable const& slhb_options();

/// Returns chosen settings as command-line options that reproduce the picture.
std::string as_options(RenderSettings const& chosen);

/// Returns the decisions of choose_settings for a scene, with reasons, as items of the plan.
std::vector<PlanItem> explain_settings(World const& world, RenderSettings const& asked, Camera const& camera);

/// True if some path may have to continue with an exact ray, or the camera needs them (orthographic cameras are
/// not rasterised yet).
bool needs_exact_rays(World const& world, bool orthographic, SlhbSettings const& chosen);

} // namespace gi
