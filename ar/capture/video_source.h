#pragma once
// Videos, V4L2 cameras and GStreamer pipelines through OpenCV.

#include "ar/capture/frame_source.h"

#include <filesystem>
#include <memory>

namespace ar {

/// A video file, decoded by FFmpeg. Frames are bgr8, captured when they are due (origin: file). Decoders hide what
/// is damaged as well as they can, and leave out what they cannot: what is missing at the end of the frames that
/// the file says it has is counted as refused (one is let pass: some containers only estimate).
/// @throws gi::InputError no such file, no video, no frame in it
std::unique_ptr<FrameSource> open_video(std::filesystem::path const& file, Pace pace = Pace::own);

struct LiveOptions {
    glm::ivec2 size_px{0};                  ///< 0: as the device likes
    double frames_per_s = 0;                ///< 0: as the device likes
    std::optional<PixelFormat> format = {}; ///< yuyv or mjpeg: the camera's own bytes; else bgr8
    Delivery delivery = Delivery::newest;
    Controls controls = {};
};

/// A camera by its V4L2 number (0 = /dev/video0). Frames carry the driver's time where it gives one. How many were
/// lost before they came is not known: OpenCV keeps the driver's numbers to itself. A device that gives no more
/// frames ends in the state lost.
/// @throws gi::InputError no such camera, no frame from it
std::unique_ptr<FrameSource> open_device(int number, LiveOptions const& options = {});

/// A GStreamer pipeline that ends in an appsink: "videotestsrc ! videoconvert ! appsink". Without times of its
/// own: frames are bgr8 or gray8 and as old as they are when they come (origin: arrival). A pipeline that stops
/// has ended if it said how long it would be, and is lost if it did not.
/// @throws gi::InputError it cannot be built, or gives no frame
std::unique_ptr<FrameSource> open_pipeline(std::string const& pipeline, LiveOptions const& options = {});

} // namespace ar
