#pragma once
// Pairs rendered at a lower resolution: what virtual objects change in the place (shadows, indirect light) is
// smooth but for the surfaces it falls on, so it is brought to the frame's size with the proxies as guides (joint
// bilateral upsampling, Kopf et al. 2007). What objects themselves show has sharp borders: coverage and the
// radiance seen directly come at full size and are never upsampled.

#include "ar/composite/rendered_pair.h"

namespace ar {

/// What the proxies are in each pixel. Empty pictures are not used.
struct SurfaceGuides {
    cv::Mat normal; ///< CV_32FC3, length 1
    cv::Mat depth;  ///< CV_32FC1, metres along the axis, > 0; 0 = nothing is there
    cv::Mat albedo; ///< CV_32FC3: differences are upsampled as light that falls on the surface, then multiplied
};

/// At the frame's size.
struct DirectlySeen {
    cv::Mat radiance; ///< CV_32FC3, of virtual objects alone, times their coverage
    cv::Mat coverage; ///< CV_32FC1
};

struct UpsampleSettings {
    double normal_power = 32;      ///< weight: exp(-power (1 - cosine)), about cosine^power
    double depth_tolerance = 0.02; ///< of the depth: the weight's sigma
};

struct UpsampleCounts {
    std::size_t without_guide = 0; ///< pixels whose guides fit to no neighbour's: their mean
    std::size_t no_sample = 0; ///< pixels with objects in all low pixels around: no change of the place is known
};

/// Output pixel (x, y) has its centre at ((x + 0.5) low / full - 0.5) of the low pictures.
/// @param low         with, without, coverage at the low resolution; pixels that objects cover are left out, but
/// for the part beside them where `direct` is given and a quarter or more is left
/// @param low_guides  of the low resolution; empty pictures where `guides` has some are @throws gi::InputError
/// @param seen        its size is that of the result
/// @return with = seen + (1 - a)(without + change), without, coverage: a pair for Compositor. Its `without` is the
/// low one, stretched: good for differences; ratios need a full one, which `without_full` brings (may be empty).
RenderedPair upsampled(RenderedPair const& low, SurfaceGuides const& low_guides, DirectlySeen const& seen,
                       SurfaceGuides const& guides, UpsampleSettings const& settings = {},
                       cv::Mat const& without_full = {}, UpsampleCounts* counts = nullptr);

} // namespace ar
