#pragma once
// Upsamples pairs rendered at a lower resolution. The changes that virtual objects cause in the place (shadows,
// indirect light) are smooth on each surface, so they are upsampled with the proxies as guides (joint
// bilateral upsampling, Kopf et al. 2007). Objects themselves have sharp borders: their coverage and directly seen
// radiance are supplied at full size and never upsampled.

#include "ar/composite/rendered_pair.h"

namespace ar {

/// Properties of the proxies at each pixel. Empty pictures are ignored.
struct SurfaceGuides {
    cv::Mat normal; ///< CV_32FC3, length 1
    cv::Mat depth;  ///< CV_32FC1, metres along the axis, > 0; 0 = no surface
    cv::Mat albedo; ///< CV_32FC3: differences are divided by it, upsampled as incident light, and multiplied again
};

/// Directly visible virtual objects at the frame's size.
struct DirectlySeen {
    cv::Mat radiance; ///< CV_32FC3, of virtual objects alone, times their coverage
    cv::Mat coverage; ///< CV_32FC1
};

struct UpsampleSettings {
    double normal_power = 32;      ///< weight: exp(-power (1 - cosine)), about cosine^power
    double depth_tolerance = 0.02; ///< sigma of the weight, relative to depth
};

struct UpsampleCounts {
    std::size_t without_guide = 0; ///< pixels whose guides match no neighbour's; they get the neighbours' mean
    std::size_t no_sample = 0;     ///< pixels with objects in all low-resolution pixels around: change unknown
};

/// Upsamples rendered light. The centre of output pixel (x, y) lies at ((x + 0.5) low / full -
/// 0.5) in the low-resolution pictures.
/// @param low         with, without, coverage at the low resolution; pixels covered by objects are left out,
/// except for their uncovered part if `direct` is given and at least a quarter of the pixel is uncovered
/// @param guides, low_guides  at both resolutions; may be undefined further than 4 pixels of the low one from
/// changes and objects.
/// @throws gi::InputError if one is empty that `guides` has
/// @param seen        determines the size of the result
/// @return with = seen + (1 - a)(without + change), without, coverage: a pair for Compositor. Its `without` is the
/// low one, enlarged, which is sufficient for differences; ratios need a full one: `without_full` (may be empty).
RenderedPair upsampled(RenderedPair const& low, SurfaceGuides const& low_guides, DirectlySeen const& seen,
                       SurfaceGuides const& guides, UpsampleSettings const& settings = {},
                       cv::Mat const& without_full = {}, UpsampleCounts* counts = nullptr);

} // namespace ar
