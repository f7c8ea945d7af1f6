#include "ar/pipeline/quick_view.h"

#include "ar/composite/warp.h"
#include "ar/pipeline/bridge.h"

#include <cmath>
#include <numbers>

namespace ar {
namespace {

constexpr double kResolution = 1.25; ///< pixels rasterised per pixel of the camera, as synthetic_radiance

float sky(float y) { return 0.7f + 0.3f * y; }
/// Radiance of a matt surface with this normal, per albedo: irradiance / pi = 0.7 + 0.3 * 2/3 y.
float reflected(float y) { return 0.7f + 0.2f * y; }

} // namespace

cv::Mat quick_sky(int height)
{
    cv::Mat map(height, 2 * height, CV_32FC3);
    for (int y = 0; y < map.rows; ++y)
        map.row(y).setTo(cv::Scalar::all(sky(float(std::cos(std::numbers::pi * (y + 0.5) / map.rows)))));
    return map;
}

QuickView::QuickView(gi::Scene const& scene, gi::Report& report)
    : world_(gi::build_world(std::make_shared<gi::Scene const>(scene), std::nullopt, report)),
      surfaces_(world_, Surfaces::all)
{
}

cv::Mat QuickView::radiance(CameraModel const& camera, gi::RigidPose const& world_from_camera, int samples)
{
    CameraModel const pinhole = covering_pinhole(camera, kResolution);
    gi::Camera const view = gi_camera(pinhole, world_from_camera);
    cv::Mat sum(pinhole.size_px.y, pinhole.size_px.x, CV_32FC3, cv::Scalar::all(0));
    int const passes = std::max(1, int(std::lround(samples / (kResolution * kResolution))));
    for (int k = 0; k < passes; ++k) {
        FirstSurfaces const s = surfaces_.seen(view, sum.cols, sum.rows, std::uint32_t(k));
        sum.forEach<cv::Vec3f>([&](cv::Vec3f& to, int const* at) {
            to += reflected(s.normal.at<cv::Vec3f>(at[0], at[1])[1]) * s.albedo.at<cv::Vec3f>(at[0], at[1]);
        });
    }
    return Warp(camera, pinhole).smooth(sum / passes);
}

} // namespace ar
