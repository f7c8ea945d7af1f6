#pragma once
#include "gi/scene/model/world.h"

#include <glm/vec2.hpp>
#include <optional>
#include <string>

namespace viewer {

inline constexpr double kDefaultFov_deg = 45;

/// One of two eyes beside the camera, which share a virtual screen.
struct EyeChoice {
    bool right = false;
    double eye_distance_m = 0.063;
    std::optional<double> screen_distance_m; ///< m along the view; what lies there has no disparity
    glm::ivec2 size{1};                      ///< of the picture, pixels
};

/// What the command line says about the point of view; all may be empty.
struct CameraChoice {
    std::string name;
    std::optional<gi::dvec3> look_from, look_at;
    std::optional<double> fov_deg, aperture_radius_m, focus_distance_m;
    std::optional<EyeChoice> eye; ///< of FrameCamera alone
};

struct ChosenCamera {
    gi::Camera camera;
    std::string note; ///< what was decided for the user; empty = nothing
};

/// Puts the lens that was chosen before a camera; what is not chosen stays.
/// @param focus  what is in focus where neither says that   @param what  that is, for messages
/// @return what was decided for the user; empty = nothing
/// Throws InputError where there is no such lens, or the focus is not before the camera.
std::string put_lens(gi::Camera& camera, CameraChoice const& choice, std::optional<gi::dvec3> focus,
                     std::string const& what);

/// The named camera, or the one looked from, or the scene's first, or one that frames the whole scene.
/// Throws InputError on unknown names (it lists the known ones), half-given or contradictory positions, a field of
/// view or a lens for an orthographic camera, a lens without a focus, and cameras too far away to compute with.
ChosenCamera choose_camera(gi::World const& world, CameraChoice const& choice);
/// Throws InputError where a camera is too far away to compute with.
void check_distance(gi::World const& world, gi::Camera const& camera);

} // namespace viewer
