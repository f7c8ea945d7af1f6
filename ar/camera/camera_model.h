#pragma once
// Projection models of OpenCV's calib3d. A point of the camera's frame (x right, y down, z ahead) is projected to
// the plane z = 1, distorted there by the lens, and mapped to (fx x + cx, fy y + cy). Pixel centres have
// integer coordinates: the picture spans [-0.5, width - 0.5].
//   radial_tangential  k1 k2 p1 p2 k3            Brown 1966
//   rational           k1 k2 p1 p2 k3 k4 k5 k6   the same over 1 + k4 r^2 + k5 r^4 + k6 r^6
//   fisheye            k1 k2 k3 k4               Kannala and Brandt 2006, of the angle to the axis
//   stmap              no coefficients: a table of rays (LensTable)

#include "ar/camera/lens_table.h"

#include <array>
#include <glm/glm.hpp>
#include <memory>
#include <opencv2/core.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace ar {

enum class LensModel { pinhole, radial_tangential, rational, fisheye, stmap };
/// Number of distortion coefficients: 0, 5, 8, 4, 0.
int coefficient_count(LensModel lens);
/// Name in calibration files: "pinhole", "radial_tangential", "rational", "fisheye", "stmap".
std::string name_of(LensModel lens);
std::optional<LensModel> lens_named(std::string const& name);

struct CameraModel {
    LensModel lens = LensModel::pinhole;
    glm::ivec2 size_px{0};
    double fx = 0, fy = 0;                       ///< pixels
    double cx = 0, cy = 0;                       ///< pixels
    std::array<double, 8> distortion{};          ///< in the order above; unused coefficients are 0
    std::shared_ptr<LensTable const> table = {}; ///< of the lens stmap; pictures of another size scale it

    friend bool operator==(CameraModel const&, CameraModel const&) = default;
};

/// The 3x3 matrix of focal lengths and principal point.
cv::Matx33d camera_matrix(CameraModel const& camera);
/// Distortion coefficients for OpenCV's functions, 1 x coefficient_count.
cv::Mat distortion_of(CameraModel const& camera);

/// Projects a point of the camera's frame to pixels; nothing if it is not in front of the camera (for fisheye: if
/// it is at the camera), or beyond the first pole or fold of the lens (ar/camera/lens_domain.h).
std::optional<glm::dvec2> project(CameraModel const& camera, glm::dvec3 point);
/// Unit direction (camera's frame) of a pixel. Inverts `project` to 1e-9 where the lens is invertible; nothing
/// where the iteration does not converge (outside the range of the model).
std::optional<glm::dvec3> direction_of(CameraModel const& camera, glm::dvec2 pixel);

/// The same camera for pictures of another size from the same sensor.
CameraModel scaled(CameraModel const& camera, glm::ivec2 size_px);

/// Table for cv::remap: the position in pictures of `from` of each pixel of `to` (2 floats, x and y); both cameras
/// have the same pose. Pixels outside the view of `from`: (-1e4, -1e4).
cv::Mat remap_table(CameraModel const& to, CameraModel const& from);

/// @throws gi::InputError values that are not finite, no focal length, no size, a principal point far outside the
/// picture, a distortion that is not monotonic or has a pole within the picture (for fisheye: in more than half of
/// it, since its corners may be dark); `where` begins the message
void check(CameraModel const& camera, std::string const& where);

} // namespace ar
