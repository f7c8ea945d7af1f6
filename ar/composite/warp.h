#pragma once
// Renderers produce pinhole pictures, but the camera has a lens. The rendered pictures are warped to the
// camera's picture, whose bytes are never resampled.

#include "ar/camera/camera_model.h"
#include "ar/composite/rendered_pair.h"

namespace ar {

/// The smallest pinhole camera with the same position and direction that covers the field of view of `camera`.
/// @param resolution  its pixels per pixel of the camera, at the centre of the lens; > 0
/// @throws gi::InputError if the camera sees 80 degrees or more off its axis, or the picture exceeds 16384 pixels
CameraModel covering_pinhole(CameraModel const& camera, double resolution = 1);

/// Warps pictures between two cameras with the same pose; the table is computed once.
class Warp {
public:
    /// @param to    the camera
    /// @param from  the pinhole that is rendered
    Warp(CameraModel const& to, CameraModel const& from);

    /// Bilinear, to 1/32 of a pixel (cv::remap). Outside the view of `from` all pictures are 0,
    /// so composites keep the camera's bytes. Equal pixels of `with` and `without` stay equal bit for bit.
    /// @throws gi::InputError wrong size
    RenderedPair operator()(RenderedPair const& pair) const;
    /// Bilinear, for radiance and irradiance.
    cv::Mat smooth(cv::Mat const& picture) const;
    /// Nearest pixel, for depth, normals and surface numbers.
    cv::Mat nearest(cv::Mat const& picture) const;

    /// Number of the camera's pixels outside the view of `from`.
    int unseen_px() const { return unseen_px_; }
    CameraModel const& from() const { return from_; }
    CameraModel const& to() const { return to_; }

private:
    cv::Mat remapped(cv::Mat const& picture, int interpolation) const;
    CameraModel to_, from_;
    cv::Mat table_, fractions_; ///< from cv::convertMaps: fixed point, faster
    cv::Mat table_nearest_;
    int unseen_px_ = 0;
    bool same_ = false;
};

} // namespace ar
