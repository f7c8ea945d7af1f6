#include "viewer/offline/choose_camera.h"

#include "gi/core/edit_distance.h"
#include "gi/core/error.h"
#include "viewer/offline/first_view.h"

#include <algorithm>
#include <fmt/format.h>

namespace viewer {
namespace {

/// Squared lengths of rays from farther away overflow float.
constexpr double kFarthest_m = 1e12;

gi::Camera with_fov(gi::Camera camera, std::optional<double> fov_deg)
{
    if (!fov_deg) return camera;
    if (camera.orthographic)
        throw gi::InputError("--fov is given for the camera '" + camera.name + "'",
                             "it is orthographic and has no field of view", "drop it or choose another camera");
    camera.yfov_rad = glm::radians(*fov_deg);
    return camera;
}

gi::Camera const& named_camera(gi::World const& world, std::string const& name)
{
    std::vector<std::string> known;
    for (gi::Camera const& c : world.cameras) {
        if (c.name == name) return c;
        known.push_back(c.name);
    }
    throw gi::InputError("there is no camera '" + name + "'", "the scene does not have it",
                         known.empty() ? "it has none: give --look-from and --look-at" : gi::suggest(name, known));
}

} // namespace

std::string put_lens(gi::Camera& camera, CameraChoice const& choice, std::optional<gi::dvec3> focus,
                     std::string const& what)
{
    if (choice.aperture_radius_m) camera.aperture_radius_m = *choice.aperture_radius_m;
    if (choice.focus_distance_m) camera.focus_distance_m = *choice.focus_distance_m;
    if (camera.aperture_radius_m == 0) {
        if (choice.focus_distance_m)
            throw gi::InputError("--focus-distance is given for a pinhole", "everything is in focus",
                                 "add --aperture-radius 0.02, or leave it out");
        camera.focus_distance_m = 0;
        return {};
    }
    std::string note;
    if (camera.focus_distance_m == 0 && !camera.orthographic) {
        double const distance = focus ? glm::dot(gi::dvec3(camera.world_from_camera[3]) - *focus,
                                                 gi::dvec3(camera.world_from_camera[2]))
                                      : 0;
        if (!(distance >= gi::kNearestFocus_m))
            throw gi::InputError("--aperture-radius without --focus-distance",
                                 focus ? what + " is not in front of the camera" : "the focus is not known",
                                 "add --focus-distance, m along the view");
        camera.focus_distance_m = distance;
        note = fmt::format("in focus: {:.3g} m in front of the camera, as far as {}", distance, what);
    }
    check_lens(camera);
    return note;
}

void check_distance(gi::World const& world, gi::Camera const& camera)
{
    double const distance = glm::length(gi::dvec3(camera.world_from_camera[3]) - world.origin);
    if (!(distance < kFarthest_m))
        throw gi::InputError("the camera is too far away",
                             fmt::format("{:.3g} m from the middle of the scene, at most {:.0e} m can be computed",
                                         distance, kFarthest_m),
                             "move it closer");
}

ChosenCamera choose_camera(gi::World const& world, CameraChoice const& choice)
{
    if (choice.look_from && !choice.name.empty())
        throw gi::InputError("--camera and --look-from are both given", "they contradict each other", "drop one");
    if (choice.look_at && !choice.look_from)
        throw gi::InputError("--look-at is given alone", "it needs a position", "add --look-from x,y,z");

    double const fov_deg = choice.fov_deg.value_or(kDefaultFov_deg);
    bool const empty = world.bounds.empty();
    gi::dvec3 const center = gi::dvec3(empty ? gi::vec3{0} : world.bounds.center()) + world.origin;
    ChosenCamera chosen;
    if (choice.look_from) {
        chosen.camera = gi::look_at(*choice.look_from, choice.look_at.value_or(center), fov_deg);
    } else if (!choice.name.empty()) {
        chosen.camera = with_fov(named_camera(world, choice.name), choice.fov_deg);
    } else if (!world.cameras.empty()) {
        chosen.camera = with_fov(world.cameras.front(), choice.fov_deg);
    } else {
        std::optional<gi::Camera> inside;
        if (!choice.turns) inside = view_from_inside(world, choice.fov_deg.value_or(kInsideFov_deg));
        chosen.camera = inside.value_or(view_from_outside(world, detailed_part(world), fov_deg));
        chosen.note = inside ? "the scene has no camera: inside it, at eye height"
                             : "the scene has no camera: looking at all of it from the front";
    }
    check_distance(world, chosen.camera);
    std::string const lens = put_lens(chosen.camera, choice, choice.look_at.value_or(center),
                                      choice.look_at ? "the point looked at" : "the middle of the scene");
    if (!lens.empty()) chosen.note += (chosen.note.empty() ? "" : "; ") + lens;
    return chosen;
}

} // namespace viewer
