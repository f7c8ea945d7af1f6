#pragma once
// Motion blur: while the shutter is open, each path is traced at a moment of its own (Cook, Porter and Carpenter
// 1984; per pass in Yu 2012, sec. 7.2), so that the mean of paths is blurred.

#include "gi/methods/registry.h"
#include "viewer/offline/frame_camera.h"

namespace viewer {

struct Exposure {
    double from_s = 0, shutter_s = 0; ///< opening, in scene time, and duration, s
    bool still = false;               ///< only the camera may move, not the scene
    std::function<gi::Camera(gi::World const&, double after_s)> camera; ///< at `after_s` after the opening
};

/// Note to the user if --shutter has no effect.
inline constexpr char const* kNothingMoves = "--shutter does nothing: neither the scene nor the camera moves";

/// True if the picture depends on the time.
/// @param scene_still  the scene is not animated, even if it could be
bool depends_on_time(gi::Scene const& scene, bool scene_still, CameraMotion const& camera);

/// Renders a picture with motion blur.
/// @param world  at the opening of the shutter, before and after the call
/// Throws InputError on settings that do not work with the motion.
gi::RenderResult expose(gi::Method const& method, gi::MovingWorld& world, Exposure const& exposure,
                        gi::RenderSettings const& settings, gi::StopRequest const& stop,
                        gi::RenderProgress const& progress, gi::Report& report);

/// Distinguishes exposures that open at the same moment: hash of the world when the shutter closes and of the
/// camera while it is open. @param world  is advanced to the closing
std::uint64_t motion_fingerprint(gi::MovingWorld& world, Exposure const& exposure,
                                 gi::RenderSettings const& settings, std::string const& method);

} // namespace viewer
