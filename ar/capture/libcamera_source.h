#pragma once
// Cameras through libcamera, of version 0.0.3 (Debian 12) or 0.4 (Debian 13) from one source.

#include "ar/capture/frame_source.h"

#include <memory>

namespace ar {

struct CameraEntry {
    std::string id;   ///< lasting: names the same camera tomorrow
    std::string name; ///< model
};

/// All that are plugged in now. Empty also where nothing was ever plugged in.
/// @throws gi::InputError libcamera does not start
std::vector<CameraEntry> list_cameras();
std::string libcamera_version();

struct LibcameraOptions {
    std::string id = {}; ///< of `list_cameras`, or a name that only one of them has; empty: the first
    glm::ivec2 size_px{640, 480};
    std::optional<PixelFormat> format = {}; ///< empty: what costs least
    int buffers = 4;
    Delivery delivery = Delivery::newest;
    Controls controls = {}; ///< from the first frame on
};

/// A running camera. What it cannot do of size and rate it does as near as it can: `description` says what came of
/// it. Planes are the camera's own memory where the format allows (see camera_pixels.h); the camera fills it again
/// once the last copy of the frame is gone, and so loses frames while as many are kept as it has buffers. They
/// stay readable after the camera was closed. An unplugged camera ends in the state lost.
/// @throws gi::InputError there is no camera, none of that name, it is in use, or has no format that is known here
std::unique_ptr<FrameSource> open_libcamera(LibcameraOptions const& options = {});

} // namespace ar
