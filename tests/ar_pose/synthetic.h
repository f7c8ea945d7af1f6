#pragma once
// Cameras that look at a 3 x 3 grid of markers (or a marker, or a board) from where the test knows.

#include "ar/camera/camera_model.h"
#include "ar/camera/pose.h"
#include "ar/camera/sighting.h"
#include "gi/core/rotation.h"

#include <cmath>
#include <random>

namespace ar::test {

inline CameraModel camera_640(LensModel lens = LensModel::radial_tangential)
{
    CameraModel c{lens, {640, 480}, 600, 602, 318.5, 243.25, {}};
    if (lens == LensModel::radial_tangential) c.distortion = {-0.12, 0.05, 0.001, -0.0007, 0};
    if (lens == LensModel::fisheye) {
        c.fx = c.fy = 260;
        c.distortion = {0.03, -0.01, 0.004, -0.001};
    }
    return c;
}

/// The corners of square markers on the plane y = 0, a row of three each way; `side_m` wide, `step_m` apart.
inline std::vector<SightedPoint> marker_grid(double side_m = 0.06, double step_m = 0.15)
{
    std::vector<SightedPoint> points;
    for (int m = 0; m < 9; ++m)
        for (int c = 0; c < 4; ++c) {
            double const x = (m % 3 - 1) * step_m + side_m * (c == 1 || c == 2 ? 0.5 : -0.5);
            double const z = (m / 3 - 1) * step_m + side_m * (c >= 2 ? 0.5 : -0.5);
            points.push_back({{x, 0, z}, {}, m, 0.1});
        }
    return points;
}

inline std::vector<SightedPoint> one_marker(double side_m)
{
    std::vector<SightedPoint> points = marker_grid(side_m, 0);
    points.resize(4);
    return points;
}

/// From `eye` looking at `target`, turned about the line of sight.
inline gi::RigidPose looking(glm::dvec3 eye, glm::dvec3 target, double roll_rad = 0)
{
    glm::dvec3 const z = glm::normalize(target - eye);
    glm::dvec3 const up = std::abs(z.y) < 0.99 ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, 1);
    glm::dvec3 const x = glm::normalize(glm::cross(z, up));
    glm::dmat3 const m(x, glm::cross(z, x), z);
    return {eye, glm::normalize(glm::quat_cast(m) * gi::exp_rotation({0, 0, roll_rad}))};
}

/// About `distance_m` from the origin, in the upper half, at most 60 degrees from its pole.
inline gi::RigidPose random_view(std::mt19937& random, double distance_m)
{
    std::uniform_real_distribution<double> u(0, 1);
    double const turn = 2 * 3.14159265 * u(random), tilt = glm::radians(60.0) * u(random);
    glm::dvec3 const eye =
        distance_m * glm::dvec3(std::sin(tilt) * std::cos(turn), std::cos(tilt), std::sin(tilt) * std::sin(turn));
    return looking(eye, {0.1 * u(random) - 0.05, 0, 0.1 * u(random) - 0.05}, 6.28 * u(random));
}

inline Sighting sight(std::vector<SightedPoint> points, CameraModel const& camera,
                      gi::RigidPose const& world_from_camera, double noise_px, std::mt19937& random)
{
    std::normal_distribution<double> noise(0, 1);
    Sighting s;
    for (SightedPoint& p : points) {
        auto const at = project(camera, inverse(world_from_camera) * p.world_m);
        glm::dvec2 const miss(noise(random), noise(random));
        if (!at) continue;
        p.pixel = *at + noise_px * miss;
        p.sigma_px = std::max(0.01, noise_px);
        s.points.push_back(p);
    }
    return s;
}

} // namespace ar::test
