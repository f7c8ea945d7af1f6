#pragma once
// What virtual things show themselves, at the frame's size, from a pair that was rendered at a lower one: which
// pixels they cover is rasterised anew, and the light that falls on them is that of the rendered pixels around
// which show a like surface (joint bilateral upsampling, Kopf et al. 2007). Mirrors and highlights on them stay as
// coarse as they were rendered.

#include "ar/composite/upsample.h"
#include "viewer/ar/first_surfaces.h"
#include "viewer/ar/pair_renderer.h"

#include <memory>

namespace viewer {

/// Each of the frame's size.
struct SharpSurfaces {
    ar::DirectlySeen seen;       ///< less what proxies hide
    ar::DirectlySeen unoccluded; ///< as if proxies hid nothing; empty unless asked for
    std::size_t unlit = 0; ///< points of pixels without any rendered pixel near by that shows the things: black
};

class VirtualSurfaces {
public:
    /// @param world  outlives this; with everything that is virtual in its place when it is asked
    explicit VirtualSurfaces(gi::World const& world) : world_(world), all_(world, Surfaces::all) {}

    /// The world has moved.
    void moved();
    /// @param low   direct and coverage are read  @param size  of the result; sees what `camera` does
    SharpSurfaces at_size(PairPictures const& low, gi::Camera const& camera, cv::Size size, bool with_unoccluded);

private:
    gi::World const& world_;
    SurfaceView all_;
    std::unique_ptr<SurfaceView> virtual_; ///< made when it is asked for
};

/// Guides for what is real, of pictures of any size that see what `camera` does. Albedo is the mean of so many
/// points of the pixel.
ar::SurfaceGuides guides_of(SurfaceView const& real, gi::Camera const& camera, cv::Size size, cv::Rect region,
                            int points);
/// The rectangle of what is not 0, wider by some pixels; empty where all is.
cv::Rect around(cv::Mat const& mask, int by_px);
/// What of a picture of another size a rectangle covers.
cv::Rect scaled(cv::Rect rectangle, cv::Size from, cv::Size to);

} // namespace viewer
