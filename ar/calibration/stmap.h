#pragma once
// STMaps, by which compositing programs distort and undistort pictures: OpenEXR with two channels, R = s and G =
// t, which say for each pixel where in the source picture it comes from. Nuke's convention: s = (x + 0.5) / width,
// t = 1 - (y + 0.5) / height of the source, at pixel centres, the origin at the bottom left. Undistorted pictures
// have the size, focal lengths and principal point of the distorted ones; values beyond 0..1 lie outside of them.

#include "ar/camera/camera_model.h"
#include "gi/core/report.h"

#include <filesystem>

namespace ar {

enum class StMap {
    distort,  ///< for pixels of the camera's picture: where it is in the undistorted one
    undistort ///< for pixels of the undistorted picture: where it is in the camera's
};

/// CV_32FC2 (s, t) of the camera's size. Pixels without a place in the source: (-1, -1), outside of it.
cv::Mat stmap_of(CameraModel const& camera, StMap which);

/// Number of pixels that are (-1, -1).
int placeless_px(cv::Mat const& st);

/// Writes CV_32FC2 in single precision. @throws gi::InputError
void write_stmap(std::filesystem::path const& file, cv::Mat const& st);

/// The camera with the lens that a map `distort` describes, in place of its own. @throws gi::InputError no OpenEXR
/// file with channels R and G, a size other than the camera's, values that are not finite, a map that folds
/// @param report  if not null: what was cut or left out of the file
CameraModel with_stmap(CameraModel const& camera, std::filesystem::path const& file, gi::Report* report = nullptr);

} // namespace ar
