#include "ar/capture/opencv/opencv_sources.h"

#include <opencv2/core/utils/logger.hpp>

ar::OpenCvSources const* lightwell_capture()
{
    cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT); // the caller reports errors
    static constexpr ar::OpenCvSources kSources{ar::opencv::open_video, ar::opencv::open_device,
                                                ar::opencv::open_pipeline};
    return &kSources;
}
