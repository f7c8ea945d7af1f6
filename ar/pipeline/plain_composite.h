#pragma once
// Baseline for benchmarks: the compositing equation written directly with OpenCV, one whole picture per step.

#include "ar/composite/rendered_pair.h"

namespace ar {

/// with + (1 - a)(camera - without), for a camera with sRGB bytes: decoded by table, encoded by powers.
/// @param rgb CV_8UC3
cv::Mat plain_composite(cv::Mat const& rgb, RenderedPair const& pair);

} // namespace ar
