#include "viewer/choose_camera.h"

#include "gi/base/error.h"

namespace viewer {

ChosenCamera choose_camera(gi::World const& world, CameraChoice const& choice)
{
    gi::dvec3 const center = gi::dvec3(world.bounds.empty() ? gi::vec3{0} : world.bounds.center()) + world.origin;
    double const radius = world.bounds.empty() ? 1.0 : std::max(double(world.bounds.radius()), 1e-6);
    if (choice.look_from) {
        if (!choice.name.empty())
            throw gi::InputError("--camera and --look-from are both given", "they contradict each other",
                                 "drop one");
        return {gi::look_at(*choice.look_from, choice.look_at.value_or(center), choice.fov_deg.value_or(45)), ""};
    }
    if (choice.look_at)
        throw gi::InputError("--look-at is given alone", "it is not known from where", "add --look-from x,y,z");
    if (!choice.name.empty()) {
        std::string known;
        for (gi::Camera const& c : world.cameras) {
            if (c.name == choice.name) {
                ChosenCamera chosen{c, ""};
                if (choice.fov_deg) chosen.camera.yfov_rad = glm::radians(*choice.fov_deg);
                return chosen;
            }
            known += (known.empty() ? "" : ", ") + c.name;
        }
        throw gi::InputError("there is no camera '" + choice.name + "'", "the scene does not have it",
                             known.empty() ? "it has none: give --look-from and --look-at"
                                           : "choose one of: " + known);
    }
    if (!world.cameras.empty()) {
        ChosenCamera chosen{world.cameras.front(), ""};
        if (choice.fov_deg) chosen.camera.yfov_rad = glm::radians(*choice.fov_deg);
        return chosen;
    }
    double const fov_deg = choice.fov_deg.value_or(45);
    double const distance = 1.05 * radius / std::sin(0.5 * glm::radians(fov_deg));
    gi::dvec3 const from = center + distance * glm::normalize(gi::dvec3{0.5, 0.35, 1});
    return {gi::look_at(from, center, fov_deg), "the scene has no camera: looking at all of it from the front"};
}

} // namespace viewer
