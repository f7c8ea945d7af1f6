#pragma once
// How the scene plan chooses the settings of paths, hit buffers and shadow maps that were not given, and why.

#include "gi/hit_buffers/settings.h"
#include "gi/methods/paths/algorithm.h"
#include "gi/methods/paths/costs.h"
#include "gi/methods/paths/settings.h"
#include "gi/raster/triangle_soup.h"
#include "gi/render/render_option.h"
#include "gi/scene/model/camera.h"
#include "gi/scene/model/plan.h"

namespace gi {

/// Options of all methods whose paths start at the camera.
RenderOptionTable const& paths_options();

Costs costs_of(World const& world, TriangleSoup const& soup);

/// Returns settings in which every number of PathsSettings and SlhbSettings is chosen, for asked.of<PathAlgorithm>().
/// Throws InputError on incompatible values.
RenderSettings choose_settings(RenderSettings const& asked, World const& world, TriangleSoup const& soup);

/// The same for frame sequences: the budget is per frame and does not include building lasting structures.
RenderSettings choose_frame_settings(RenderSettings const& asked, World const& world, TriangleSoup const& soup);

/// Returns chosen settings as command-line options that reproduce the picture.
std::string as_options(RenderSettings const& chosen);

/// Returns the decisions of choose_settings for a scene, with reasons, as items of the plan.
std::vector<PlanItem> explain_choices(World const& world, RenderSettings const& asked, Camera const& camera);

/// True if some path may have to continue with an exact ray, or the camera needs them (orthographic cameras are
/// not rasterised yet).
bool needs_exact_rays(World const& world, bool orthographic, RenderSettings const& chosen);

} // namespace gi
