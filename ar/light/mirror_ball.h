#pragma once
// Environments from pictures of a mirror ball (Debevec 1998), exact for cameras at a finite distance.
//
// Seen from the camera's centre a ball is a cone: rays to its rim make the half angle a = asin(R / D) with the ray
// to its centre, through whatever lens; in the picture of a pinhole that is an ellipse. The rim's unit rays d
// satisfy
//   d.m = 1,   m = axis / cos a,
// three unknowns, linear. What the ball reflects depends on a alone while the surround is far away.

#include "ar/camera/camera_model.h"
#include "ar/camera/pose.h"
#include "ar/light/lat_long.h"

#include <optional>

namespace ar {

/// Where the camera sees the ball.
struct BallSight {
    glm::dvec3 axis{0, 0, 1};  ///< to its centre, of length 1, camera's frame
    double half_angle_rad = 0; ///< of its rim
    double rms_px = 0;         ///< of the rim's points that were used; 0 where predicted
    int rim_points = 0;        ///< used, of 360
};

/// Of a ball of known radius at a known place. Nothing if it is behind the camera or the camera is in it.
std::optional<BallSight> predicted_ball(Pose const& world_from_camera, glm::dvec3 centre_m, double radius_m);
/// The ball whose rim a circle drawn on the picture roughly is.
/// @throws gi::InputError no radius, or not in the picture
BallSight ball_of_circle(CameraModel const& camera, glm::dvec2 centre_px, double radius_px);
/// Distance of its centre, by its radius: R / sin a.
double ball_distance_m(BallSight const& ball, double radius_m);

/// The rim in the picture to a fraction of a pixel: steepest change of luminance across the rim of `near` within
/// +- `search` of its half angle, in 360 places; then the cone by least squares with robust weights.
/// A perfect mirror before what it reflects at grazing angles has no rim: real ones are darker than their
/// surround.
/// @param rgb CV_8UC3 or CV_32FC3
/// @throws gi::InputError if fewer than 60 places agree
BallSight find_ball(cv::Mat const& rgb, CameraModel const& camera, BallSight const& near, double search = 0.15);
/// The same, beginning at the strongest circle of the picture (Hough), of a radius of at least 1/40 of its height.
BallSight find_ball(cv::Mat const& rgb, CameraModel const& camera);

struct BallSettings {
    cv::Size size{512, 256};
    cv::Vec3d reflectivity{1, 1, 1};    ///< of the ball, by channel: steel is about 0.6
    double camera_half_angle_rad = 0.1; ///< as seen from the ball: what camera and tripod hide of the surround
    double least_cosine = 0.1;          ///< of the angle between ray and normal: nearer to the rim is blurred
};

/// What the ball shows of the surround, in the world's directions. The weight of a direction is the cosine at the
/// ball, falling to 0 at `least_cosine`; 0 behind the ball (half angle a, and what least_cosine leaves out), where
/// the camera is, and beyond the picture. Each texel is the mean of a grid of samples as dense as the picture.
/// @param radiance CV_32FC3, of the camera's size
/// @param world_from_camera its rotation is used
/// @throws gi::InputError sizes that differ, a reflectivity that is not in ]0, 1]
PartialMap unwrap_ball(cv::Mat const& radiance, CameraModel const& camera, glm::dquat const& world_from_camera,
                       BallSight const& ball, BallSettings const& settings = {});

} // namespace ar
