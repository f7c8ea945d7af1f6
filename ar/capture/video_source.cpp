#include "ar/capture/video_source.h"

#include "ar/capture/opencv/opencv_sources.h"
#include "gi/core/module.h"

namespace ar {
namespace {

/// The sources of the OpenCV module, which the first call loads.
OpenCvSources const& sources()
{
    return *reinterpret_cast<decltype(&lightwell_capture)>(
        gi::module_function("liblightwell_capture.so", "lightwell_capture", "videos and cameras cannot be opened",
                            "install the package lightwell-ar, or build all: scripts/build release"))();
}

} // namespace

std::unique_ptr<FrameSource> open_video(std::filesystem::path const& file, Pace pace)
{
    return sources().video(file, pace);
}

std::unique_ptr<FrameSource> open_device(int number, LiveOptions const& options)
{
    return sources().device(number, options);
}

std::unique_ptr<FrameSource> open_pipeline(std::string const& pipeline, LiveOptions const& options)
{
    return sources().pipeline(pipeline, options);
}

} // namespace ar
