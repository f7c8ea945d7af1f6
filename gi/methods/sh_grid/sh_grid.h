#pragma once
// The method sh_grid (Chang, Park and Ihm, "Ray Tracing-based Interactive Diffuse Indirect Illumination"): ray
// trees of gi/methods/whitted, with indirect light from photons in grids and a field of spherical harmonics.

#include "gi/render/frame_renderer.h"
#include "gi/render/render_option.h"

namespace gi {

/// Those of its own; it also has those of whitted.
RenderOptionTable const& sh_grid_options();

/// See RenderFunction. Passes 4, 8, 16, ... of a picture average fields of other photons.
RenderResult render_sh_grid(World const& world, Camera const& camera, RenderSettings const& settings,
                            StopRequest const& stop, RenderProgress const& progress, Report& report);
/// See StartFrames. Voxels follow geometry; photons and field follow geometry, lights and materials.
std::unique_ptr<FrameRenderer> start_sh_grid_frames(MovingWorld const& world, Camera const& camera,
                                                    RenderSettings const& settings, Report& report);

} // namespace gi
