#include "ar/capture/opencv/opencv_sources.h"

ar::OpenCvSources const* lightwell_capture()
{
    static constexpr ar::OpenCvSources kSources{ar::opencv::open_video, ar::opencv::open_device,
                                                ar::opencv::open_pipeline};
    return &kSources;
}
