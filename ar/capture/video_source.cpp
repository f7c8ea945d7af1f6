#include "ar/capture/video_source.h"

#include "ar/capture/opencv/opencv_sources.h"
#include "gi/core/error.h"

#include <dlfcn.h>

namespace ar {
namespace {

/// The sources of the OpenCV module, which the first call loads.
OpenCvSources const& sources()
{
    // Counted: loaded once, and stays.
    void* const module = dlopen("liblightwell_capture.so", RTLD_NOW | RTLD_LOCAL);
    auto* const find = module != nullptr
                           ? reinterpret_cast<decltype(&lightwell_capture)>(dlsym(module, "lightwell_capture"))
                           : nullptr;
    if (find != nullptr) return *find();
    char const* const why = dlerror();
    throw gi::InputError("videos and cameras cannot be opened", why != nullptr ? why : "their module is not there",
                         "install the package lightwell-ar, or build all: scripts/build release");
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
