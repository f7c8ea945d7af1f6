#pragma once
// Cameras through libcamera 0.0.3 (Debian 12) or 0.4 (Debian 13), from the same code.

#include "ar/capture/frame_source.h"

#include <memory>

namespace ar {

struct CameraEntry {
    std::string id;   ///< persistent: names the same camera in later runs
    std::string name; ///< model
};

/// Returns the cameras that are connected now; may be empty.
/// @throws gi::InputError if libcamera does not start
std::vector<CameraEntry> list_cameras();
std::string libcamera_version();

struct LibcameraOptions {
    std::string id = {}; ///< an id of `list_cameras`, or a unique name; empty: the first camera
    glm::ivec2 size_px{640, 480};
    std::optional<PixelFormat> format = {}; ///< empty: the cheapest
    int buffers = 4;
    Delivery delivery = Delivery::newest;
    Controls controls = {}; ///< from the first frame on
};

/// Starts a camera. Unsupported sizes and rates are replaced by the nearest supported ones; `description` has the
/// values in use. Planes are the camera's own memory if the format allows (see camera_pixels.h); the camera reuses
/// it once the last copy of the frame is gone, and so loses frames while all its buffers are held. Planes
/// stay readable after the camera is closed. An unplugged camera ends in the state lost.
/// @throws gi::InputError no camera, none of that name, camera in use, or no supported format
std::unique_ptr<FrameSource> open_libcamera(LibcameraOptions const& options = {});

} // namespace ar
