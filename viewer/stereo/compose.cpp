#include "viewer/stereo/compose.h"

#include <algorithm>

namespace viewer {

glm::ivec2 eye_size(StereoMode mode, glm::ivec2 window_px)
{
    auto const half = [](int px) { return std::max(px / 2, std::min(px, 1)); };
    if (mode == StereoMode::side_by_side) return {half(window_px.x), window_px.y};
    if (mode == StereoMode::top_bottom) return {window_px.x, half(window_px.y)};
    return window_px;
}

} // namespace viewer
