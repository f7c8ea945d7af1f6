#pragma once
// What version 0.1 called slhb: exact rays or look-ups, shadow rays or shadow maps, as its options and the plan said.
// Recordings, scripts, sessions and manifests of that version name it, and render what they rendered.

#include "gi/render/method.h"

namespace gi {

/// How paths found the next surface.
enum class FormerLookUps : std::uint8_t { automatic, all, none };
enum class FormerShadows : std::uint8_t { automatic, maps, rays };

struct FormerSlhbSettings {
    FormerLookUps look_ups = FormerLookUps::automatic;
    FormerShadows shadows = FormerShadows::automatic;
};

/// See Method.
RenderOptionTable const& slhb_0_1_options();
RenderResult render_slhb_0_1(World const& world, Camera const& camera, RenderSettings const& settings,
                             StopRequest const& stop, RenderProgress const& progress, Report& report);
std::unique_ptr<FrameRenderer> start_slhb_0_1_frames(MovingWorld const& world, Camera const& camera,
                                                     RenderSettings const& settings, Report& report);
RenderSettings slhb_0_1_for_display(RenderSettings settings);
ExposurePlan slhb_0_1_exposure(World const& world, RenderSettings const& asked, Camera const& camera,
                               Triangles triangles);

} // namespace gi
