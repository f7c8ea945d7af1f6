#pragma once
// Opens a source by its command-line name.

#include "ar/capture/frame_source.h"

#include <memory>

namespace ar {

struct OpenOptions {
    glm::ivec2 size_px{640, 480}; ///< of cameras and the counter
    double frames_per_s = 30;     ///< of cameras, pictures and the counter
    /// Of pictures: the number of the one at time 0; nothing: that of the first one. Of others the first
    /// frame has the time 0.
    std::optional<std::uint64_t> first_number = {};
    std::optional<PixelFormat> format = {};
    Pace pace = Pace::own; ///< of files
    Delivery delivery = Delivery::newest;
    Controls controls = {}; ///< of cameras
};

///   camera, camera:ID       libcamera's first, or the one of that id or name
///   device:0                a V4L2 camera by its number
///   gstreamer:PIPELINE      ends in an appsink
///   counter                 generated
///   a folder                a recorded session if it has a session.json, else pictures
///   a path with %d or %04d  numbered pictures
///   a file                  a video
/// @throws gi::InputError the source does not exist or delivers no frame, a `first_number` above 0 of
/// anything but pictures
std::unique_ptr<FrameSource> open_source(std::string const& name, OpenOptions const& options = {});

} // namespace ar
