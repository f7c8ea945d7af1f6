#include "viewer/experiment/stimuli/study_scenes.h"
#include "viewer/offline/choose_camera.h"
#include "viewer/offline/load_world.h"

namespace viewer {

SceneAccess study_scenes()
{
    SceneAccess scenes;
    scenes.load = [](std::string const& name, gi::Report& report) {
        RenderOptions options;
        options.scene = name;
        options.light = "white"; // stimuli stay what they were
        return load_lit_scene(options, report);
    };
    scenes.camera = [](gi::World const& world, std::string const& name) {
        CameraChoice choice;
        choice.name = name;
        return choose_camera(world, choice).camera;
    };
    return scenes;
}

} // namespace viewer
