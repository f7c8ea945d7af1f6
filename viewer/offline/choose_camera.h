#pragma once
// Chooses the camera of `render` from the options, the scene's cameras, or a view of the whole scene.

#include "gi/scene/model/world.h"

#include <glm/vec2.hpp>
#include <optional>
#include <string>

namespace viewer {

inline constexpr double kDefaultFov_deg = 45;
inline constexpr double kInsideFov_deg = 65; ///< of a camera chosen inside a room

/// One of the two eyes of a stereo pair, beside the camera. Both share a virtual screen.
struct EyeChoice {
    bool right = false;
    double eye_distance_m = 0.063;
    std::optional<double> screen_distance_m; ///< m along the view; points there have no disparity
    glm::ivec2 size{1};                      ///< of the picture, pixels
};

/// Camera options of the command line; all may be empty.
struct CameraChoice {
    std::string name;
    std::optional<gi::dvec3> look_from, look_at;
    std::optional<double> fov_deg, aperture_radius_m, focus_distance_m;
    bool turns = false;           ///< the camera will turn around the scene, so it has to be outside
    std::optional<EyeChoice> eye; ///< used by FrameCamera only
};

struct ChosenCamera {
    gi::Camera camera;
    std::string note; ///< defaults that were chosen, for a note to the user; empty = none
};

/// Applies the lens options to a camera; values that are not given keep those of the camera.
/// @param focus  point in focus if options and camera give no distance   @param what  its name, for messages
/// @return defaults that were chosen, for a note to the user; empty = none
/// Throws InputError if there is no such lens, or if the focus is not in front of the camera.
std::string put_lens(gi::Camera& camera, CameraChoice const& choice, std::optional<gi::dvec3> focus,
                     std::string const& what);

/// Returns the named camera, the one of look_from, the scene's first, or one chosen for the scene (first_view.h).
/// Throws InputError on unknown names (listing the known ones), incomplete or contradictory positions, a field of
/// view or a lens for an orthographic camera, a lens without a focus, and cameras too far away for float.
ChosenCamera choose_camera(gi::World const& world, CameraChoice const& choice);
/// Throws InputError if the camera is too far away for float precision.
void check_distance(gi::World const& world, gi::Camera const& camera);

} // namespace viewer
