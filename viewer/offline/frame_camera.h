#pragma once
#include "gi/scene/model/camera_path.h"
#include "viewer/offline/choose_camera.h"

namespace viewer {

/// How the point of view moves over frames: not, along a path, or round the scene.
struct CameraMotion {
    std::optional<gi::CameraPath> path;
    double turn_rad = 0; ///< over all frames, about +Y, counter-clockwise from above
};

/// "" = once round, "2" turns, "90deg". Throws InputError.
double parse_turn(std::string const& text);

/// The cameras of all frames.
class FrameCamera {
public:
    /// @param first the world of the first frame: its middle is circled, and a camera that frames the whole scene
    ///              stays where it is then; what a lens focuses on, and where the screen of two eyes is, without
    ///              being told how far
    /// Throws InputError as choose_camera does, and where an eye of an orthographic camera is asked for.
    FrameCamera(gi::World const& first, CameraChoice const& choice, CameraMotion const& motion);

    /// @param time_s on the path   @param fraction of the turn, 0..1
    gi::Camera of(gi::World const& world, double time_s, double fraction) const;
    std::string const& note() const { return first_.note; }

private:
    gi::Camera middle(gi::World const& world, double time_s, double fraction) const;
    void place_screen(gi::World const& first);

    CameraChoice choice_;
    CameraMotion motion_;
    ChosenCamera first_;
    gi::dvec3 center_{0};
    bool of_scene_ = false; ///< a camera of the scene's, which may be animated
};

} // namespace viewer
