#include "ar/pipeline/synthetic.h"

#include "ar/composite/warp.h"
#include "ar/pipeline/bridge.h"
#include "gi/core/rng.h"
#include "gi/filter/denoise.h"
#include "gi/methods/reference/reference.h"

#include <glm/gtc/matrix_transform.hpp>
#include <opencv2/imgproc.hpp>

namespace ar {
namespace {

cv::Mat rendered(gi::World const& world, gi::Camera const& camera, int width, int height, std::uint32_t paths,
                 SyntheticQuality const& quality, std::uint64_t seed, gi::StopRequest const& stop,
                 gi::Report& report)
{
    gi::RenderSettings settings;
    settings.width = width;
    settings.height = height;
    settings.paths = paths;
    settings.seed = seed;
    settings.bounces = 8;
    settings.threads = quality.threads;
    gi::RenderResult result = gi::render_reference(world, camera, settings, stop, {}, report);
    if (quality.denoise) gi::denoise(result.picture, {.threads = quality.threads});
    return matrix_of(result.picture, "color");
}

gi::RigidPose looking(glm::dvec3 from, glm::dvec3 at)
{
    glm::dvec3 const ahead = glm::normalize(at - from);
    glm::dvec3 const right = glm::normalize(glm::cross(ahead, glm::dvec3(0, 1, 0)));
    glm::dmat3 const axes(right, glm::cross(ahead, right), ahead); // x right, y down, z ahead
    return {from, glm::normalize(glm::quat_cast(axes))};
}

} // namespace

SyntheticCamera synthetic_camera(glm::ivec2 size_px)
{
    SyntheticCamera c;
    c.model.lens = LensModel::radial_tangential;
    c.model.size_px = {640, 480};
    c.model.fx = 556.3;
    c.model.fy = 554.9;
    c.model.cx = 322.4;
    c.model.cy = 236.8;
    c.model.distortion = {-0.17, 0.06, 0.0006, -0.0009, -0.004, 0, 0, 0};
    c.model = scaled(c.model, size_px);
    c.photometry = srgb_photometry();
    c.photometry.radiance_per_unit = 1;
    return c;
}

gi::RigidPose synthetic_pose(double t)
{
    double const turn = 2 * glm::pi<double>() * t;
    double const azimuth = glm::radians(-24 + 48 * t) + 0.02 * std::sin(5 * turn);
    double const elevation = glm::radians(33 + 5 * std::sin(turn)) + 0.008 * std::sin(7 * turn + 1);
    double const distance = 0.98 + 0.07 * std::cos(turn + 0.5) + 0.004 * std::sin(11 * turn);
    glm::dvec3 const at(0.01 * std::sin(3 * turn), 0.08 + 0.006 * std::sin(9 * turn), 0);
    return looking(at + distance * glm::dvec3(std::cos(elevation) * std::sin(azimuth), std::sin(elevation),
                                              std::cos(elevation) * std::cos(azimuth)),
                   at);
}

gi::RigidPose synthetic_pose_apart(double t)
{
    double const turn = 2 * glm::pi<double>() * t;
    double const azimuth = glm::radians(14 * std::sin(1.5 * turn) + 5) + 0.02 * std::sin(6 * turn);
    double const elevation = glm::radians(36 + 6 * std::cos(1.3 * turn)) + 0.01 * std::sin(8 * turn + 2);
    double const distance = 0.9 + 0.08 * std::sin(1.7 * turn + 1) + 0.004 * std::sin(13 * turn);
    glm::dvec3 const at(0.03 * std::sin(2 * turn), 0.06, 0.03 * std::cos(2.5 * turn));
    return looking(at + distance * glm::dvec3(std::cos(elevation) * std::sin(azimuth), std::sin(elevation),
                                              std::cos(elevation) * std::cos(azimuth)),
                   at);
}

cv::Mat synthetic_radiance(gi::Scene const& scene, std::optional<double> time_s, CameraModel const& camera,
                           gi::RigidPose const& world_from_camera, SyntheticQuality const& quality,
                           std::uint64_t seed, gi::StopRequest const& stop, gi::Report& report)
{
    CameraModel const pinhole = covering_pinhole(camera, quality.resolution);
    double const per_pixel = quality.resolution * quality.resolution;
    auto const paths = std::uint32_t(std::max(1.0, std::round(quality.paths / per_pixel)));
    gi::World const world = gi::build_world(std::make_shared<gi::Scene const>(scene), time_s, report);
    cv::Mat const flat = rendered(world, gi_camera(pinhole, world_from_camera), pinhole.size_px.x,
                                  pinhole.size_px.y, paths, quality, seed, stop, report);
    return Warp(camera, pinhole).smooth(flat);
}

cv::Mat synthetic_frame(cv::Mat const& radiance, SyntheticCamera const& camera, std::uint64_t frame)
{
    cv::Mat noisy = radiance.clone();
    double const unit = camera.photometry.radiance_per_unit;
    for (int y = 0; y < noisy.rows; ++y) {
        gi::Pcg32 rng = gi::Pcg32::for_path(frame, 0x5e50, std::uint32_t(y));
        for (int x = 0; x < noisy.cols; ++x)
            for (int c = 0; c < 3; ++c) {
                // Box and Muller.
                double const u = 1 - rng.uniform(), v = rng.uniform();
                double const normal = std::sqrt(-2 * std::log(u)) * std::cos(2 * glm::pi<double>() * v);
                float& value = noisy.at<cv::Vec3f>(y, x)[c];
                double const variance =
                    camera.read_noise * camera.read_noise + camera.photon_noise * std::max(0.0, value / unit);
                value = float(value + unit * std::sqrt(variance) * normal);
            }
    }
    return bytes_of(noisy, camera.photometry);
}

cv::Mat synthetic_probe(gi::Scene const& scene, gi::dvec3 place_m, int height, SyntheticQuality const& quality,
                        gi::StopRequest const& stop, gi::Report& report)
{
    gi::World const world = gi::build_world(std::make_shared<gi::Scene const>(scene), std::nullopt, report);
    int const face = height; // pixels a side: finer than the map
    std::array<gi::dvec3, 6> const ahead{{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}}};
    std::array<cv::Mat, 6> faces;
    std::array<gi::Camera, 6> cameras;
    for (std::size_t f = 0; f < 6; ++f) {
        gi::dvec3 const up = std::abs(ahead[f].y) > 0 ? gi::dvec3(0, 0, 1) : gi::dvec3(0, 1, 0);
        cameras[f].off_axis = {-1, 1, -1, 1};
        cameras[f].world_from_camera = glm::inverse(glm::lookAt(place_m, place_m + ahead[f], up));
        faces[f] = rendered(world, cameras[f], face, face, quality.paths, quality, 77 + f, stop, report);
    }
    cv::Mat map(height, 2 * height, CV_32FC3);
    for (int y = 0; y < map.rows; ++y)
        for (int x = 0; x < map.cols; ++x) {
            double const polar = glm::pi<double>() * (y + 0.5) / map.rows;
            double const azimuth = 2 * glm::pi<double>() * ((x + 0.5) / map.cols - 0.5);
            gi::dvec3 const d(std::sin(polar) * std::sin(azimuth), std::cos(polar),
                              -std::sin(polar) * std::cos(azimuth));
            std::size_t best = 0;
            for (std::size_t f = 1; f < 6; ++f)
                if (glm::dot(d, ahead[f]) > glm::dot(d, ahead[best])) best = f;
            // Looks along -z.
            gi::dvec3 const local = glm::transpose(glm::dmat3(cameras[best].world_from_camera)) * d;
            double const px = 0.5 * face * (1 + local.x / -local.z) - 0.5,
                         py = 0.5 * face * (1 - local.y / -local.z) - 0.5;
            cv::Mat one;
            cv::getRectSubPix(faces[best], {1, 1}, cv::Point2f(float(px), float(py)), one);
            map.at<cv::Vec3f>(y, x) = one.at<cv::Vec3f>(0, 0);
        }
    return map;
}

} // namespace ar
