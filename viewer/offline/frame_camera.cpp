#include "viewer/offline/frame_camera.h"

#include "gi/core/error.h"
#include "gi/core/text.h"
#include "viewer/base/arguments.h"
#include "viewer/displays/desktop_views.h"

#include <algorithm>
#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>

namespace viewer {

double parse_turn(std::string const& text)
{
    constexpr double kMostTurns = 1000;
    if (text.empty()) return 2 * std::numbers::pi;
    bool const degrees = text.ends_with("deg");
    auto const value = gi::parse_finite(std::string_view(text).substr(0, text.size() - (degrees ? 3 : 0)));
    double const turns = value.value_or(0) / (degrees ? 360 : 1);
    if (turns == 0 || !(std::abs(turns) <= kMostTurns))
        throw gi::InputError("--turntable '" + text + "' is not understood",
                             "turns or degrees are needed, other than 0 and at most 1000 turns",
                             "write --turntable 1 or --turntable 90deg");
    return turns * 2 * std::numbers::pi;
}

FrameCamera::FrameCamera(gi::World const& first, CameraChoice const& choice, CameraMotion const& motion)
    : choice_(choice), motion_(motion)
{
    if (motion_.path) {
        gi::Camera any; // throws early if the lens is invalid
        put_lens(any, choice_, std::nullopt, "");
        if (choice_.eye) place_screen(first);
        return;
    }
    choice_.turns = motion_.turn_rad != 0;
    first_ = choose_camera(first, choice_);
    choice_.aperture_radius_m = first_.camera.aperture_radius_m;
    if (first_.camera.aperture_radius_m > 0) choice_.focus_distance_m = first_.camera.focus_distance_m;
    of_scene_ = !choice.look_from && !first.cameras.empty();
    center_ = choice.look_at.value_or(gi::dvec3(first.bounds.empty() ? gi::vec3{0} : first.bounds.center()) +
                                      first.origin);
    if (choice_.eye) place_screen(first);
}

/// Places the virtual screen as the viewer does; its distance is constant for all frames.
void FrameCamera::place_screen(gi::World const& first)
{
    constexpr double kNearest_m = 0.2, kFarthest_m = 1e4;
    if (!motion_.path && first_.camera.orthographic)
        throw gi::InputError("--eye with the camera '" + first_.camera.name + "'",
                             "it is orthographic: its rays are parallel and start at no eye",
                             "choose a perspective camera");
    if (choice_.eye->screen_distance_m) return;
    gi::dvec3 const from =
        motion_.path ? motion_.path->keys.front().from : gi::dvec3(first_.camera.world_from_camera[3]);
    gi::dvec3 const middle = gi::dvec3(first.bounds.empty() ? gi::vec3{0} : first.bounds.center()) + first.origin;
    double const distance = std::clamp(glm::length(middle - from), kNearest_m, kFarthest_m);
    choice_.eye->screen_distance_m = distance;
    first_.note += fmt::format("{}the pictures of the two eyes coincide {:.3g} m in front of the camera, at the "
                               "distance of the middle of the scene",
                               first_.note.empty() ? "" : "; ", distance);
}

gi::Camera FrameCamera::of(gi::World const& world, double time_s, double fraction) const
{
    gi::Camera camera = middle(world, time_s, fraction);
    if (!choice_.eye) return camera;
    EyeChoice const& eye = *choice_.eye;
    auto const views =
        desktop_views(camera, {true, eye.eye_distance_m, *eye.screen_distance_m}, eye.size, eye.size);
    return views[eye.right ? 1 : 0].camera;
}

gi::Camera FrameCamera::middle(gi::World const& world, double time_s, double fraction) const
{
    if (motion_.path) {
        gi::Camera camera =
            gi::camera_at(*motion_.path, time_s, glm::radians(choice_.fov_deg.value_or(kDefaultFov_deg)));
        check_distance(world, camera);
        put_lens(camera, choice_, std::nullopt, "");
        return camera;
    }
    gi::Camera camera = of_scene_ ? choose_camera(world, choice_).camera : first_.camera;
    if (double const angle = motion_.turn_rad * fraction; angle != 0)
        camera.world_from_camera = glm::translate(gi::dmat4(1), center_) *
                                   glm::rotate(gi::dmat4(1), angle, gi::dvec3{0, 1, 0}) *
                                   glm::translate(gi::dmat4(1), -center_) * camera.world_from_camera;
    return camera;
}

} // namespace viewer
