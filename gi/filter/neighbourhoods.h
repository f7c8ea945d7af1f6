#pragma once
// Mean and deviations of direct light in the neighbourhood of each pixel, to clamp the light of earlier frames.

#include "gi/filter/temporal.h"

#include <opencv2/core.hpp>

namespace gi {

/// Statistics of direct light over albedo in windows around pixels: computed for all pixels at once, or pixel by
/// pixel if only few are needed.
class Neighbourhoods {
public:
    /// The layers must outlive this object.
    Neighbourhoods(Layer const& l1, Layer const& albedo, int width, int height, bool few,
                   TemporalSettings const& settings);
    struct Range {
        vec3 low, high;
    };
    /// Mean +- deviations of the window around a pixel.
    Range around(int x, int y) const;

private:
    vec3 direct_at(int x, int y) const;

    Layer const &l1_, &albedo_;
    int width_, height_, window_;
    float spread_;
    bool few_;
    cv::Mat mean_, squares_; ///< 3 channels
};

} // namespace gi
