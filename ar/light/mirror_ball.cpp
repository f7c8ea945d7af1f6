#include "ar/light/mirror_ball.h"

#include "ar/light/picture_sampling.h"
#include "gi/core/error.h"

#include <cmath>
#include <fmt/format.h>
#include <numbers>

namespace ar {
namespace {

/// The angle at the ball's centre, from the camera to the point that reflects what comes from `toward`, itself an
/// angle from the camera: solves 2 t + atan2(s sin t, 1 - s cos t) = toward by Newton's method, s = R / D.
double reflecting_angle(double s, double toward)
{
    double t = toward / 2;
    for (int i = 0; i < 8; ++i) {
        double const x = 1 - s * std::cos(t), y = s * std::sin(t);
        double const miss = 2 * t + std::atan2(y, x) - toward;
        t -= miss / (2 + s * (std::cos(t) - s) / (x * x + y * y));
    }
    return t;
}

} // namespace

std::optional<BallSight> predicted_ball(gi::RigidPose const& world_from_camera, glm::dvec3 centre_m,
                                        double radius_m)
{
    glm::dvec3 const centre = inverse(world_from_camera) * centre_m;
    double const distance = glm::length(centre);
    if (!(radius_m > 0 && distance > radius_m && centre.z > 0)) return std::nullopt;
    return BallSight{centre / distance, std::asin(radius_m / distance), 0, 0};
}

BallSight ball_of_circle(CameraModel const& camera, glm::dvec2 centre_px, double radius_px)
{
    glm::dvec3 sum(0);
    std::array<std::optional<glm::dvec3>, 4> rim;
    std::array<glm::dvec2, 4> const sides{{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}};
    for (std::size_t i = 0; i < 4; ++i) {
        rim[i] = direction_of(camera, centre_px + radius_px * sides[i]);
        if (!(radius_px > 0) || !rim[i])
            throw gi::InputError(
                fmt::format("a ball of radius {} px at ({}, {})", radius_px, centre_px.x, centre_px.y),
                "no rays go there", "give the circle that the ball's rim is in the picture");
        sum += *rim[i];
    }
    BallSight b;
    b.axis = glm::normalize(sum);
    for (auto const& d : rim) b.half_angle_rad += std::acos(std::min(1.0, glm::dot(*d, b.axis))) / 4;
    return b;
}

double ball_distance_m(BallSight const& ball, double radius_m) { return radius_m / std::sin(ball.half_angle_rad); }

PartialMap unwrap_ball(cv::Mat const& radiance, CameraModel const& camera, glm::dquat const& world_from_camera,
                       BallSight const& ball, BallSettings const& settings)
{
    for (double const r : settings.reflectivity.val)
        if (!(r > 0 && r <= 1))
            throw gi::InputError(fmt::format("a mirror ball that reflects {}", r), "it reflects between 0 and all",
                                 "give the share of each channel, 0.6 for steel");
    check_picture(radiance, camera, "picture of a mirror ball");
    double const s = std::sin(ball.half_angle_rad);
    double const unseen = std::numbers::pi - ball.half_angle_rad; // directions beyond: behind the ball
    glm::dvec3 const to_camera = -ball.axis;
    glm::dquat const camera_from_world = glm::conjugate(world_from_camera);
    auto const look = [&](glm::dvec3 world) -> PictureSample {
        glm::dvec3 const d = camera_from_world * world;
        double const toward = std::acos(std::clamp(glm::dot(d, to_camera), -1.0, 1.0));
        if (toward < settings.camera_half_angle_rad || toward >= unseen) return {};
        double const t = reflecting_angle(s, toward);
        glm::dvec3 const across = d - glm::dot(d, to_camera) * to_camera;
        double const length = glm::length(across);
        glm::dvec3 const side = length > 1e-12 ? across / length : glm::dvec3(0);
        glm::dvec3 const normal = std::cos(t) * to_camera + std::sin(t) * side;
        glm::dvec3 const at = ball.axis + s * normal;
        double const cosine = glm::dot(normal, -glm::normalize(at));
        double const weight = (cosine - settings.least_cosine) / (1 - settings.least_cosine);
        auto const pixel = project(camera, at);
        return weight > 0 && pixel ? PictureSample{*pixel, weight} : PictureSample{};
    };
    // The ball is equal-area: pi r^2 pixels for the whole sphere.
    double const radius_px = std::sqrt(camera.fx * camera.fy) * std::tan(ball.half_angle_rad);
    double const pixels_per_texel = std::numbers::pi * radius_px / settings.size.width;
    PartialMap out = gather(radiance, settings.size, pixels_per_texel, look);
    out.radiance = out.radiance.mul(
        cv::Scalar(1 / settings.reflectivity[0], 1 / settings.reflectivity[1], 1 / settings.reflectivity[2]));
    return out;
}

} // namespace ar
