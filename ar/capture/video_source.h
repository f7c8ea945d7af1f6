#pragma once
// Videos, V4L2 cameras and GStreamer pipelines through OpenCV.

#include "ar/capture/frame_source.h"

#include <filesystem>
#include <memory>

namespace ar {

/// A video file, decoded by FFmpeg. Frames are bgr8, captured when they are due (origin: file). Decoders conceal
/// damage where they can and omit frames where they cannot: frames missing at the end, by the file's own frame
/// count, are counted as refused (one missing frame is tolerated: some containers only estimate the count).
/// @throws gi::InputError no such file, not a video, no frame in it
std::unique_ptr<FrameSource> open_video(std::filesystem::path const& file, Pace pace = Pace::own);

struct LiveOptions {
    glm::ivec2 size_px{0};                  ///< 0: the device's default
    double frames_per_s = 0;                ///< 0: the device's default
    std::optional<PixelFormat> format = {}; ///< yuyv or mjpeg: the camera's own bytes; else bgr8
    Delivery delivery = Delivery::newest;
    Controls controls = {};
};

/// A camera by its V4L2 number (0 = /dev/video0). Frames have the driver's timestamp if there is one. The number
/// of frames lost before arrival is unknown: OpenCV does not expose the driver's sequence numbers. A device that
/// stops delivering frames ends in the state lost.
/// @throws gi::InputError no such camera, or it delivers no frame
std::unique_ptr<FrameSource> open_device(int number, LiveOptions const& options = {});

/// A GStreamer pipeline that ends in an appsink: "videotestsrc ! videoconvert ! appsink".
/// Frames are bgr8 or gray8 and stamped with their arrival (origin: arrival).
/// A pipeline that stops has ended if it had a known length, and is lost otherwise.
/// @throws gi::InputError the pipeline cannot be built, or delivers no frame
std::unique_ptr<FrameSource> open_pipeline(std::string const& pipeline, LiveOptions const& options = {});

} // namespace ar
