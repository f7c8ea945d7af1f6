#include "viewer/offline/load_world.h"

#include "gi/core/error.h"
#include "gi/scene/load/load.h"
#include "viewer/base/arguments.h"
#include "viewer/base/standard_streams.h"
#include "viewer/offline/scene_light.h"

#include <algorithm>
#include <memory>

namespace viewer {
namespace {

/// Returns what add_light() has added.
std::string set_environment(gi::Scene& scene, RenderOptions const& o, gi::Report& report)
{
    if (!o.environment.empty()) {
        bool const replaces = scene.environment.has_value();
        scene.environment = gi::load_environment(o.environment, report);
        scene.files.push_back(o.environment);
        if (replaces) say("--envmap replaces the scene's environment map");
    }
    std::string const added = add_light(scene, o.light);
    if (!added.empty()) say(added);
    if (!added.empty() && (o.environment_rotate_deg != 0 || o.environment_scale != 1))
        say("--envmap-rotate and --envmap-scale turn and scale the light that was added: no --envmap is given");
    if (scene.environment) {
        scene.environment->rotation_rad += float(glm::radians(o.environment_rotate_deg));
        scene.environment->scale *= float(o.environment_scale);
    } else if (o.environment_rotate_deg != 0 || o.environment_scale != 1) {
        say("--envmap-rotate and --envmap-scale do nothing: the scene has no environment map");
    }
    return added;
}

} // namespace

gi::Background parse_background(std::string const& text)
{
    if (text == "map") return {};
    if (text == "transparent") return {gi::BackgroundKind::transparent, gi::vec3{0}};
    if (text.find(',') == std::string::npos)
        throw gi::InputError("--background '" + text + "' is not understood", "there is no such background",
                             "write map, transparent or a colour: 0.1,0.2,0.3");
    return {gi::BackgroundKind::color, gi::vec3(parse_color("--background", text))};
}

CameraChoice camera_choice(RenderOptions const& o)
{
    CameraChoice choice;
    choice.name = o.camera;
    if (!o.look_from.empty()) choice.look_from = parse_point("--look-from", o.look_from);
    if (!o.look_at.empty()) choice.look_at = parse_point("--look-at", o.look_at);
    choice.fov_deg = o.fov_deg;
    choice.aperture_radius_m = o.aperture_radius_m;
    choice.focus_distance_m = o.focus_distance_m;
    if (!o.eye.empty()) {
        auto const [width, height] = parse_size(o.size);
        choice.eye = EyeChoice{o.eye == "right", o.eye_distance_m, o.screen_distance_m, {width, height}};
    }
    return choice;
}

LitScene lit_scene(RenderOptions const& o, gi::Report& report)
{
    gi::StageTimer const timer(report, "load");
    gi::Scene scene = gi::load_scene(o.scene, report);
    std::string const added = set_environment(scene, o, report);
    if (!o.background.empty()) scene.background = parse_background(o.background);
    return {std::make_shared<gi::Scene const>(std::move(scene)), added};
}

std::shared_ptr<gi::Scene const> load_lit_scene(RenderOptions const& o, gi::Report& report)
{
    return lit_scene(o, report).scene;
}

gi::World load_world(RenderOptions const& o, gi::Report& report)
{
    auto const scene = load_lit_scene(o, report);
    gi::StageTimer const timer(report, "world");
    return gi::build_world(scene, o.time_s, report);
}

} // namespace viewer
