#pragma once
// The headlight: a white point light at the eye that goes with the head, for scenes where no lamp was meant. While it is
// on, it is the last node and the last punctual light of the scene, so that every method has it; while it is off, the
// scene is as if there were none.
//
// Viewers that rasterise have a directional light along the view (vtkLight's headlight in ParaView, MeshLab's default
// light). With shadows, that would be stopped by the wall behind the viewer. At the eye none of its shadows are seen.

#include "gi/scene/model/world.h"
#include "viewer/protocol/frame_command.h"

#include <memory>
#include <span>

namespace viewer {

/// Of a world: the ball around it when it was built.
struct Headlight {
    gi::dvec3 center{0}; ///< m, world
    double radius_m = 1;
};
Headlight headlight_of(gi::World const& world);

/// The eye of the first user, m, world: in the middle between the first view's and its partner's. There is a view.
gi::dvec3 eye_of(std::span<ViewCommand const> views);

/// The light for an eye: a white matt surface that faces it as far away as the middle of the scene, but not nearer than
/// the radius, has radiance 1; others by the inverse square.
gi::Light light_at(Headlight const& headlight, gi::dvec3 eye_m, gi::dvec3 world_origin);

std::shared_ptr<gi::Scene const> with_headlight(gi::Scene const& scene);
/// Inverse of with_headlight().
std::shared_ptr<gi::Scene const> without_headlight(gi::Scene const& scene);

} // namespace viewer
