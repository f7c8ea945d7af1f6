#pragma once
// The method paths: path tracing by exact rays, with a pool of light samples from which every path chooses by
// resampling, a radiance cache, and in frames light that one eye reuses from the other. Also the CPU form of the
// methods that find surfaces or shadows by look-ups (gi/methods/slhb), as PathAlgorithm says.

#include "gi/methods/paths/algorithm.h"
#include "gi/render/method.h"

namespace gi {

/// See Method. Throws InputError on incompatible settings.
RenderResult render_paths(World const& world, Camera const& camera, RenderSettings const& settings,
                          StopRequest const& stop, RenderProgress const& progress, Report& report);
std::unique_ptr<FrameRenderer> start_path_frames(MovingWorld const& world, Camera const& camera,
                                                 RenderSettings const& settings, Report& report);

/// The same with a single layered hit buffer of the view in place of rays by broad lobes (screen_layers.h). Throw InputError
/// on orthographic cameras.
RenderResult render_screen_lhb(World const& world, Camera const& camera, RenderSettings const& settings,
                               StopRequest const& stop, RenderProgress const& progress, Report& report);
/// See Method.
void check_screen_lhb_options(std::vector<std::string> const& given, RenderSettings const& settings);
std::unique_ptr<FrameRenderer> start_screen_lhb_frames(MovingWorld const& world, Camera const& camera,
                                                       RenderSettings const& settings, Report& report);

/// The same, where a view with a lens is shaded once and gathered from its layers (layered_lens.h).
RenderResult render_layered_lens(World const& world, Camera const& camera, RenderSettings const& settings,
                                 StopRequest const& stop, RenderProgress const& progress, Report& report);
void check_layered_lens_options(std::vector<std::string> const& given, RenderSettings const& settings);
std::unique_ptr<FrameRenderer> start_layered_lens_frames(MovingWorld const& world, Camera const& camera,
                                                         RenderSettings const& settings, Report& report);

RenderSettings paths_for_display(RenderSettings settings);
ExposurePlan paths_exposure(World const& world, RenderSettings const& asked, Camera const& camera,
                            Triangles triangles);

/// The same with settings.of<PathAlgorithm>(). @param name  of the method, for checkpoints
RenderResult render_by(char const* name, World const& world, Camera const& camera, RenderSettings const& settings,
                       StopRequest const& stop, RenderProgress const& progress, Report& report);
std::unique_ptr<FrameRenderer> start_frames_by(MovingWorld const& world, Camera const& camera,
                                               RenderSettings const& settings, Report& report);

} // namespace gi
