#pragma once
// What compositing costs a program that writes the equation down with OpenCV, a whole picture per step. A peer to
// measure against.

#include "ar/composite/rendered_pair.h"

namespace viewer {

/// with + (1 - a)(camera - without), of a camera whose bytes are sRGB: to light by table, back by powers.
/// @param rgb CV_8UC3
cv::Mat plain_composite(cv::Mat const& rgb, ar::RenderedPair const& pair);

} // namespace viewer
