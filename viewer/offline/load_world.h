#pragma once
// Makes a world and a camera from the command-line options of scene, sky and camera.

#include "gi/scene/model/world.h"
#include "viewer/offline/choose_camera.h"
#include "viewer/offline/render_options.h"

namespace viewer {

/// Parses the camera options, without needing the world. Throws InputError if they are invalid.
CameraChoice camera_choice(RenderOptions const& options);

/// Parses "map", "transparent" or a colour "R,G,B". Throws InputError on anything else.
gi::Background parse_background(std::string const& text);

struct LitScene {
    std::shared_ptr<gi::Scene const> scene;
    std::string added; ///< light, as add_light() says; empty = none
};

/// Loads the scene, applies the environment map, and adds light as RenderOptions::light says. Prints notes on stderr.
LitScene lit_scene(RenderOptions const& options, gi::Report& report);
std::shared_ptr<gi::Scene const> load_lit_scene(RenderOptions const& options, gi::Report& report);
/// Loads the scene and builds its world at the time of the options.
gi::World load_world(RenderOptions const& options, gi::Report& report);

} // namespace viewer
