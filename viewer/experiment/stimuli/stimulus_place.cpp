#include "viewer/experiment/stimuli/stimulus_place.h"

#include "viewer/displays/compose.h"
#include "viewer/displays/desktop_views.h"

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>

namespace viewer {
namespace {

constexpr double kOrbit = 0.02; ///< radius of the path relative to the scene's radius

} // namespace

StimulusPlace place_of(gi::World const& world, gi::Camera const& camera)
{
    StimulusPlace place;
    place.camera = camera;
    if (world.bounds.empty()) return place;
    place.radius_m = double(world.bounds.radius());
    gi::dvec3 const middle = world.origin + gi::dvec3(world.bounds.center());
    place.screen_distance_m =
        std::clamp(glm::length(middle - gi::dvec3(place.camera.world_from_camera[3])), 0.2, 1e4);
    return place;
}

std::vector<ViewCommand> stimulus_views(StimulusPlace const& place, StimulusSettings const& stimulus,
                                        StimulusView const& view, double seconds)
{
    gi::Camera camera = place.camera;
    camera.world_from_camera[3].y += stimulus.raise_m;
    if (stimulus.fov_deg) camera.yfov_rad = glm::radians(*stimulus.fov_deg);
    if (stimulus.path == StimulusPath::orbit) {
        double const angle = 2 * gi::kPi * std::max(0.0, seconds) / view.duration_s;
        // The path starts at the camera's own position.
        gi::dvec3 const way = kOrbit * place.radius_m * gi::dvec3(std::sin(angle), 0, 1 - std::cos(angle));
        camera.world_from_camera = camera.world_from_camera * glm::translate(gi::dmat4(1), way);
    }
    if (view.on_walls) return view.on_walls(camera);
    glm::ivec2 const eye = eye_size(view.stereo, view.size_px);
    if (eye.x <= 0 || eye.y <= 0) return {};
    DesktopStereo const stereo{view.stereo != StereoMode::off, stimulus.settings.eye_distance_m,
                               place.screen_distance_m};
    return desktop_views(camera, stereo, view.size_px, eye);
}

} // namespace viewer
