#pragma once
// Methods whose indirect light comes from photons, at the points of ray trees (gi/methods/whitted):
//   ispm         image-space photon mapping (McGuire and Luebke 2009): photons splatted
//                over the surfaces on screen
//   lpv          light propagation volumes (Kaplanyan and Dachsbacher 2010): virtual lights, whose light goes from
//                cell to cell of a lattice
//   multi_image  multi-image-based photon tracing (Fei and Wang): light paths through distance impostors, a light
//                gathering volume, and one in screen space for caustics
//   isllpm       image-space light lattice photon mapping (Noren and Sjolin): photons in lattices

#include "gi/render/frame_renderer.h"

namespace gi {

/// See RenderFunction and StartFrames.
RenderResult render_ispm(World const& world, Camera const& camera, RenderSettings const& settings,
                         StopRequest const& stop, RenderProgress const& progress, Report& report);
std::unique_ptr<FrameRenderer> start_ispm_frames(MovingWorld const& world, Camera const& camera,
                                                 RenderSettings const& settings, Report& report);
RenderResult render_lpv(World const& world, Camera const& camera, RenderSettings const& settings,
                        StopRequest const& stop, RenderProgress const& progress, Report& report);
std::unique_ptr<FrameRenderer> start_lpv_frames(MovingWorld const& world, Camera const& camera,
                                                RenderSettings const& settings, Report& report);
RenderResult render_isllpm(World const& world, Camera const& camera, RenderSettings const& settings,
                           StopRequest const& stop, RenderProgress const& progress, Report& report);
std::unique_ptr<FrameRenderer> start_isllpm_frames(MovingWorld const& world, Camera const& camera,
                                                   RenderSettings const& settings, Report& report);
RenderResult render_multi_image(World const& world, Camera const& camera, RenderSettings const& settings,
                                StopRequest const& stop, RenderProgress const& progress, Report& report);
std::unique_ptr<FrameRenderer> start_multi_image_frames(MovingWorld const& world, Camera const& camera,
                                                        RenderSettings const& settings, Report& report);

} // namespace gi
