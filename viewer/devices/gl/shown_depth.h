#pragma once

namespace viewer {

/// Depths of a picture on the GPU, along the axis of its camera: 1 / depth is per_m times a channel of its texture.
struct ShownDepth {
    unsigned texture = 0;  ///< top row first; 0 = not known
    bool in_alpha = false; ///< else in red
    float per_m = 1;
};

} // namespace viewer
