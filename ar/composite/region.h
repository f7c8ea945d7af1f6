#pragma once
// Where virtual objects changed a picture, and errors there and elsewhere.

#include "ar/composite/rendered_pair.h"

#include <cstdint>

namespace ar {

/// CV_8UC1: 255 where objects are seen, or where with and without differ by more than `threshold` of without (of
/// its largest channel, at least 1e-3 of the picture's mean); grown by `dilate_px`. What is not finite is
/// affected.
cv::Mat affected_region(RenderedPair const& pair, double threshold = 0.02, int dilate_px = 2);

/// Of bytes, all channels.
struct RegionError {
    std::size_t pixels = 0;
    double mean_absolute = 0, rms = 0; ///< bytes; 0 without pixels
    int largest = 0;
    std::size_t differing = 0; ///< pixels
};

struct CompositeError {
    RegionError inside, outside;
};

/// @param a, b  CV_8UC3 @param region  CV_8UC1. @throws InputError types or sizes
CompositeError errors_of(cv::Mat const& a, cv::Mat const& b, cv::Mat const& region);

} // namespace ar
