#pragma once
// Where a real thing stands before a virtual one, its proxy says which pixels hide the object, and proxies are a
// few pixels off. In a band around such borders the share is taken from the camera's picture instead: a local
// linear model of colour (guided filter, He et al. 2013), fitted to the pixels on both sides that are surely one
// or the other and evaluated in the band. Where colours do not tell the sides apart the proxy's border stays.

#include "ar/composite/rendered_pair.h"
#include "ar/composite/upsample.h"

namespace ar {

struct MatteSettings {
    int band_px = 5;        ///< how far proxies may be off: half the band's width
    int radius_px = 16;     ///< of the windows that a model is fitted to; > band_px
    double epsilon = 1e-3;  ///< added to the variances, relative to the mean variance in the window
    double least_fit = 0.3; ///< share of the variance that colours explain: below, the proxy's border stays ...
    double full_fit = 0.7;  ///< ... above, the model's holds; mixed between
};

struct MatteCounts {
    std::size_t band = 0;    ///< pixels looked at
    std::size_t refined = 0; ///< of them, changed
};

/// @param coverage    CV_32FC1: of virtual objects, less what proxies hide
/// @param unoccluded  CV_32FC1: of virtual objects as if nothing were before them; borders against what is behind
/// are
///                    exact and stay
/// @param camera      CV_32FC3: the frame's radiance
/// @return the coverage. @throws gi::InputError types or sizes
cv::Mat refined_coverage(cv::Mat const& coverage, cv::Mat const& unoccluded, cv::Mat const& camera,
                         MatteSettings const& settings = {}, MatteCounts* counts = nullptr);

/// The pair with another coverage. Objects that come out from behind a proxy need their radiance:
/// @param unoccluded  radiance (times coverage) and coverage of virtual objects as if nothing were before them
/// @param seen        the same with what proxies hide
/// Where objects covered more than half of a pixel the change of the place behind is not known: none.
RenderedPair with_coverage(RenderedPair const& pair, cv::Mat const& coverage, DirectlySeen const& seen,
                           DirectlySeen const& unoccluded);

} // namespace ar
