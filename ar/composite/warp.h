#pragma once
// Renderers make pictures of pinhole cameras; the camera has a lens. What was rendered is brought into the
// camera's own picture, whose bytes are never resampled.

#include "ar/camera/camera_model.h"
#include "ar/composite/rendered_pair.h"

namespace ar {

/// The smallest pinhole camera at the same place, looking the same way, that sees all that `camera` sees.
/// @param resolution  its pixels per pixel of the camera, at the centre of the lens; > 0
/// @throws gi::InputError where the camera sees 80 degrees or more off its axis, or the picture passes 16384
/// pixels
CameraModel covering_pinhole(CameraModel const& camera, double resolution = 1);

/// The table is made once, for pictures of two cameras at one place.
class Warp {
public:
    /// @param to    the camera
    /// @param from  the pinhole that is rendered
    Warp(CameraModel const& to, CameraModel const& from);

    /// Bilinear, to 1/32 of a pixel (cv::remap). Where `from` does not see: 0 in all pictures, hence the camera's
    /// bytes. What is equal in `with` and `without` stays equal bit for bit. @throws gi::InputError wrong size
    RenderedPair operator()(RenderedPair const& pair) const;
    /// Radiance, irradiance: bilinear.
    cv::Mat smooth(cv::Mat const& picture) const;
    /// Depth, normals, numbers of surfaces: the nearest pixel.
    cv::Mat nearest(cv::Mat const& picture) const;

    /// Pixels of the camera that `from` does not see.
    int unseen_px() const { return unseen_px_; }
    CameraModel const& from() const { return from_; }
    CameraModel const& to() const { return to_; }

private:
    cv::Mat remapped(cv::Mat const& picture, int interpolation) const;
    CameraModel to_, from_;
    cv::Mat table_, fractions_; ///< as cv::convertMaps makes them: fixed point, faster
    cv::Mat table_nearest_;
    int unseen_px_ = 0;
    bool same_ = false;
};

} // namespace ar
