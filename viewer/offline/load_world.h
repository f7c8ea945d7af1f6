#pragma once
// From what the command line says of scene, sky and point of view to a world and a camera.

#include "gi/scene/model/world.h"
#include "viewer/offline/choose_camera.h"
#include "viewer/offline/render_options.h"

namespace viewer {

/// Throws InputError on nonsense in the options; the world is not needed for that.
CameraChoice camera_choice(RenderOptions const& options);

/// "map", "transparent" or a colour "R,G,B". Throws InputError on anything else.
gi::Background parse_background(std::string const& text);

/// Loads the scene, sets or replaces its sky, and lights it where it has no light; says on stderr what it decided.
std::shared_ptr<gi::Scene const> load_lit_scene(RenderOptions const& options, gi::Report& report);
/// The same, and its world at the time of the options.
gi::World load_world(RenderOptions const& options, gi::Report& report);

} // namespace viewer
