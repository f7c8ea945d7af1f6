#pragma once
// Real objects that nobody modelled (hands, people) in front of virtual ones: where a measured depth or a matte
// says so, the camera's picture stays. Shadows that virtual objects would cast on them are not computed.

#include "ar/composite/rendered_pair.h"

namespace ar {

struct DepthOcclusion {
    double margin_m = 0.02; ///< how much nearer than the modelled surface a measured one must be
    double soft_m = 0.02;   ///< further distance over which it becomes opaque
    double soft_px = 1;     ///< sigma by which the share's borders are smoothed; 0 = not
};

struct OcclusionCounts {
    std::size_t holes = 0;  ///< pixels without a measured depth where something virtual is: they do not occlude
    std::size_t hidden = 0; ///< pixels with something virtual that were hidden, by half or more
};

/// Share of each pixel that a nearer real object takes, CV_32FC1, 0..1.
/// @param measured_m  CV_32FC1: along the camera's axis; 0 and non-finite values are holes
/// @param modelled_m  CV_32FC1: of virtual objects and the model of the place; 0 = nothing.
///   There the nearest depth within 2 + ceil(3 soft_px) pixels counts (at the border of a virtual object);
///   without one nothing is hidden, as nothing was added.
cv::Mat share_of_nearer(cv::Mat const& measured_m, cv::Mat const& modelled_m, DepthOcclusion const& settings);

/// Takes out of a pair what is behind occluders: its composite is (1 - share) composite + share camera.
/// @param share       CV_32FC1; changed nowhere, where it is 0; the camera's bytes stay where it is 1
/// @param measured_m  to count holes; empty = do not
void occlude(RenderedPair& pair, cv::Mat const& share, cv::Mat const& measured_m, OcclusionCounts& counts);

} // namespace ar
