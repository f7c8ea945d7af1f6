#pragma once
// The camera of each frame of a sequence.

#include "gi/scene/model/camera_path.h"
#include "viewer/offline/choose_camera.h"

namespace viewer {

/// How the camera moves over frames: not at all, along a path, or around the scene.
struct CameraMotion {
    std::optional<gi::CameraPath> path;
    double turn_rad = 0; ///< over all frames, about +Y, counter-clockwise from above
};

/// Parses "" (one turn), "2" (turns) or "90deg" and returns radians. Throws InputError.
double parse_turn(std::string const& text);

/// The cameras of all frames.
class FrameCamera {
public:
    /// @param first world of the first frame. It gives the centre of a turn, the place of a camera that frames the
    ///              whole scene, and the default distances of the lens's focus and of the virtual screen.
    /// Throws InputError as choose_camera does, and if an eye of an orthographic camera is requested.
    FrameCamera(gi::World const& first, CameraChoice const& choice, CameraMotion const& motion);

    /// @param time_s  time on the camera path   @param fraction  fraction of the turn, 0..1
    gi::Camera of(gi::World const& world, double time_s, double fraction) const;
    std::string const& note() const { return first_.note; }

private:
    gi::Camera middle(gi::World const& world, double time_s, double fraction) const;
    void place_screen(gi::World const& first);

    CameraChoice choice_;
    CameraMotion motion_;
    ChosenCamera first_;
    gi::dvec3 center_{0};
    bool of_scene_ = false; ///< it is a camera of the scene, which may be animated
};

} // namespace viewer
