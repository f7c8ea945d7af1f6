#pragma once
// Refines the border where a real object occludes a virtual one. The proxy of the real object determines which
// pixels are hidden, but proxies are a few pixels off. In a band around such borders the coverage is estimated
// from the camera's picture instead: a local linear model of colour (guided filter, He et al. 2013), fitted to the
// pixels outside the band, which surely belong to one side, and evaluated in the band. Where colours do not
// separate the sides, the proxy's border is kept.

#include "ar/composite/rendered_pair.h"
#include "ar/composite/upsample.h"

namespace ar {

struct MatteSettings {
    int band_px = 5;        ///< largest expected error of proxies: half the band's width
    int radius_px = 16;     ///< of the windows for fitting the model; > band_px
    double epsilon = 1e-3;  ///< added to the variances, relative to the mean variance in the window
    double least_fit = 0.3; ///< share of variance explained by colour: below, the proxy's border is kept ...
    double full_fit = 0.7;  ///< ... above, the model's is used; interpolated in between
};

struct MatteCounts {
    std::size_t band = 0;    ///< pixels in the band
    std::size_t refined = 0; ///< pixels changed
};

/// @param coverage    CV_32FC1: coverage by virtual objects, with occlusion by proxies
/// @param unoccluded  CV_32FC1: coverage by virtual objects without occlusion;
/// their borders against the background are exact and kept
/// @param camera      CV_32FC3: the frame's radiance
/// @return the refined coverage. @throws gi::InputError wrong types or sizes
cv::Mat refined_coverage(cv::Mat const& coverage, cv::Mat const& unoccluded, cv::Mat const& camera,
                         MatteSettings const& settings = {}, MatteCounts* counts = nullptr);

/// Replaces the coverage of a pair. Parts of objects that are no longer hidden by a proxy need their radiance:
/// @param unoccluded  radiance (times coverage) and coverage of virtual objects without occlusion
/// @param seen        the same with occlusion by proxies
/// Where objects covered more than half of a pixel, the change of the place behind is unknown and taken as none.
RenderedPair with_coverage(RenderedPair const& pair, cv::Mat const& coverage, DirectlySeen const& seen,
                           DirectlySeen const& unoccluded);

} // namespace ar
