#pragma once
// What the module liblightwell_capture.so has: sources of frames that need OpenCV's videoio, whose 240 libraries
// take 0.2 s to load. The functions of ar/capture/video_source.h load it.

#include "ar/capture/video_source.h"

namespace ar {

struct OpenCvSources {
    decltype(&open_video) video;
    decltype(&open_device) device;
    decltype(&open_pipeline) pipeline;
};

namespace opencv {

std::unique_ptr<FrameSource> open_video(std::filesystem::path const& file, Pace pace);
std::unique_ptr<FrameSource> open_device(int number, LiveOptions const& options);
std::unique_ptr<FrameSource> open_pipeline(std::string const& pipeline, LiveOptions const& options);

} // namespace opencv
} // namespace ar

/// What the module exports.
extern "C" ar::OpenCvSources const* lightwell_capture();
