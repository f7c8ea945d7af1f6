#pragma once
// Environments from pictures of a mirror ball (Debevec 1998), exact for cameras at a finite distance.
//
// From the camera's centre, the rim of a ball is a cone: rays to the rim make the half angle a = asin(R / D) with
// the ray to its centre, whatever the lens; in a pinhole picture it is an ellipse. The rim's unit rays d satisfy
//   d.m = 1,   m = axis / cos a,
// which is linear in three unknowns. The reflected directions depend only on a if the surroundings are far away.

#include "ar/camera/camera_model.h"
#include "ar/camera/pose.h"
#include "ar/light/lat_long.h"

#include <optional>

namespace ar {

/// The ball as seen by the camera.
struct BallSight {
    glm::dvec3 axis{0, 0, 1};  ///< unit vector to its centre, camera's frame
    double half_angle_rad = 0; ///< of its rim
    double rms_px = 0;         ///< of the rim points used; 0 if predicted
    int rim_points = 0;        ///< rim points used, at most 360
};

/// Cone of a ball with known radius and position; nothing if it is behind the camera or contains it.
std::optional<BallSight> predicted_ball(gi::RigidPose const& world_from_camera, glm::dvec3 centre_m,
                                        double radius_m);
/// The ball whose rim is approximately the given circle in the picture.
/// @throws gi::InputError if the radius is not positive, or the circle is not in the picture
BallSight ball_of_circle(CameraModel const& camera, glm::dvec2 centre_px, double radius_px);
/// Distance of its centre: R / sin a.
double ball_distance_m(BallSight const& ball, double radius_m);

/// Finds the rim to subpixel accuracy: the steepest change of luminance across the rim of `near` within
/// +- `search` of its half angle, at 360 positions; then fits the cone by robust least squares.
/// A perfect mirror in front of what it reflects at grazing angles has no visible rim;
/// real balls are darker than their surround.
/// @param rgb CV_8UC3 or CV_32FC3
/// @throws gi::InputError if fewer than 60 positions agree
BallSight find_ball(cv::Mat const& rgb, CameraModel const& camera, BallSight const& near, double search = 0.15);
/// The same, starting at the picture's strongest circle (Hough) with a radius of at least 1/40 of its height.
BallSight find_ball(cv::Mat const& rgb, CameraModel const& camera);

struct BallSettings {
    cv::Size size{512, 256};
    cv::Vec3d reflectivity{1, 1, 1};    ///< of the ball, per channel; steel is about 0.6
    double camera_half_angle_rad = 0.1; ///< cone hidden by camera and tripod, as seen from the ball
    double least_cosine = 0.1;          ///< between ray and normal; closer to the rim the reflection is blurred
};

/// Environment reflected by the ball, in world directions. The weight of a direction is the cosine at the
/// ball, falling to 0 at `least_cosine`; it is 0 behind the ball (half angle a, plus what least_cosine excludes),
/// at the camera, and outside the picture. Each texel is the mean of a grid of samples as dense as the picture.
/// @param radiance CV_32FC3, of the camera's size
/// @param world_from_camera only its rotation is used
/// @throws gi::InputError sizes that differ, a reflectivity outside ]0, 1]
PartialMap unwrap_ball(cv::Mat const& radiance, CameraModel const& camera, glm::dquat const& world_from_camera,
                       BallSight const& ball, BallSettings const& settings = {});

} // namespace ar
