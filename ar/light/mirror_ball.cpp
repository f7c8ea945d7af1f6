#include "ar/light/mirror_ball.h"

#include "gi/core/error.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <functional>
#include <numbers>
#include <string>

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

/// Pixel at which a world direction is seen; weight 0 = not visible.
struct PictureSample {
    glm::dvec2 pixel{0};
    double weight = 0;
};

cv::Vec3f bilinear(cv::Mat const& picture, glm::dvec2 p)
{
    int const x = std::clamp(int(p.x), 0, picture.cols - 2), y = std::clamp(int(p.y), 0, picture.rows - 2);
    auto const fx = float(p.x - x), fy = float(p.y - y);
    auto const *a = picture.ptr<cv::Vec3f>(y) + x, *b = picture.ptr<cv::Vec3f>(y + 1) + x;
    return (1 - fy) * ((1 - fx) * a[0] + fx * a[1]) + fy * ((1 - fx) * b[0] + fx * b[1]);
}

/// Each texel is the mean of the bilinearly sampled picture over a grid of directions in the texel with weight >
/// 0, by solid angle; its weight is their mean weight. Directions outside the picture are not seen.
PartialMap gather(cv::Mat const& radiance, cv::Size size, double pixels_per_texel,
                  std::function<PictureSample(glm::dvec3)> const& look)
{
    int const n = std::clamp(int(std::ceil(pixels_per_texel)), 2, 16);
    PartialMap out{cv::Mat::zeros(size, CV_32FC3), cv::Mat::zeros(size, CV_32FC1)};
    cv::parallel_for_({0, size.height}, [&](cv::Range const& rows) {
        for (int j = rows.start; j < rows.end; ++j)
            for (int i = 0; i < size.width; ++i) {
                cv::Vec3d sum(0, 0, 0);
                double seen = 0, weights = 0, all = 0;
                for (int b = 0; b < n; ++b) {
                    double const v = (j + (b + 0.5) / n) / size.height, sr = std::sin(std::numbers::pi * v);
                    for (int a = 0; a < n; ++a) {
                        all += sr;
                        PictureSample const at = look(direction_of_uv({(i + (a + 0.5) / n) / size.width, v}));
                        glm::dvec2 const p = at.pixel;
                        bool const inside =
                            p.x >= 0 && p.y >= 0 && p.x <= radiance.cols - 1 && p.y <= radiance.rows - 1;
                        if (!(at.weight > 0) || !inside) continue;
                        sum += sr * cv::Vec3d(bilinear(radiance, p));
                        seen += sr;
                        weights += sr * at.weight;
                    }
                }
                if (2 * seen < all) continue; // less than half of it
                out.radiance.at<cv::Vec3f>(j, i) = cv::Vec3f(sum / seen);
                out.weight.at<float>(j, i) = float(weights / all);
            }
    });
    return out;
}

/// @throws gi::InputError not CV_32FC3 of the camera's size, or not finite, or negative
void check_picture(cv::Mat const& radiance, CameraModel const& camera, std::string const& where)
{
    auto const refuse = [&](std::string const& problem, std::string const& why) {
        throw gi::InputError(where + ": " + problem, why,
                             "give the radiance of the whole picture, in three floats");
    };
    if (radiance.type() != CV_32FC3 || radiance.cols < 2 || radiance.rows < 2)
        refuse("it is empty or not of three floats per pixel", "radiance is");
    if (radiance.cols != camera.size_px.x || radiance.rows != camera.size_px.y)
        refuse(fmt::format("{} x {} pixels, but the camera has {} x {}", radiance.cols, radiance.rows,
                           camera.size_px.x, camera.size_px.y),
               "pixels would have the wrong rays");
    for (int y = 0; y < radiance.rows; ++y)
        for (int x = 0; x < radiance.cols; ++x)
            for (float const v : radiance.at<cv::Vec3f>(y, x).val)
                if (!(v >= 0 && std::isfinite(v)))
                    refuse(fmt::format("the pixel ({}, {}) has the value {}", x, y, v),
                           "radiance is finite and not negative");
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
