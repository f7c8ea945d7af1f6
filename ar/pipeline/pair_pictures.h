#pragma once
// Output of renderers of pairs: pictures of the place with and without the virtual objects, before compositing.

#include "ar/composite/temporal.h"

#include <cstdint>
#include <opencv2/core.hpp>

namespace ar {

/// Pictures of a pinhole camera. `with` and `without`: radiance, CV_32FC3, RGB, equal bit for bit where virtual
/// objects change nothing.
struct PairPictures {
    cv::Mat with, without;
    cv::Mat direct;                ///< CV_32FC3: part of `with` from virtual first surfaces
    cv::Mat coverage;              ///< CV_32FC1: share of the pixel whose first surface is virtual
    cv::Mat depth_m, real_depth_m; ///< CV_32FC1, along the axis: first surface with and without; 0 = none
    std::uint32_t paths = 0;       ///< per pixel of each picture; 0 = prefiltered light
    SceneChange change = SceneChange::unknown; ///< since the previous pair
};

} // namespace ar
