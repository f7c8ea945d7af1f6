#pragma once
// Pictures for which the shutter is open for a while: every path sees a moment of its own (Cook, Porter and
// Carpenter 1984; per pass in Yu 2012, sec. 7.2), so that their mean is blurred by motion.

#include "gi/methods/registry.h"
#include "viewer/offline/frame_camera.h"

namespace viewer {

struct Exposure {
    double from_s = 0, shutter_s = 0; ///< opens then, in the scene's time, for so long
    bool still = false;               ///< the scene holds still, the camera may move
    std::function<gi::Camera(gi::World const&, double after_s)> camera; ///< so long after the shutter has opened
};

/// What is to be said of --shutter then.
inline constexpr char const* kNothingMoves = "--shutter does nothing: neither the scene nor the camera moves";

/// Whether a picture depends on the moment at all.
/// @param scene_still  whatever it could do, it does not
bool depends_on_time(gi::Scene const& scene, bool scene_still, CameraMotion const& camera);

/// @param world  as it is when the shutter opens, also afterwards
/// Throws InputError on settings that do not go with what moves.
gi::RenderResult expose(gi::Method const& method, gi::MovingWorld& world, Exposure const& exposure,
                        gi::RenderSettings const& settings, gi::StopRequest const& stop,
                        gi::RenderProgress const& progress, gi::Report& report);

/// Tells exposures apart that open at the same moment: of the world as the shutter closes, and of where the camera
/// is meanwhile. @param world  is taken to the moment when it closes
std::uint64_t motion_fingerprint(gi::MovingWorld& world, Exposure const& exposure,
                                 gi::RenderSettings const& settings, std::string const& method);

} // namespace viewer
