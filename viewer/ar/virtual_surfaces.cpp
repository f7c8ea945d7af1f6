#include "viewer/ar/virtual_surfaces.h"

#include <atomic>
#include <opencv2/imgproc.hpp>

namespace viewer {
namespace {

constexpr int kPoints = 4; ///< of each pixel of the frame
constexpr float kLeastAlbedo = 0.01f;
constexpr int kReach_px = 4; ///< rendered pixels around that are looked at

/// What rendered pixels know of virtual things.
struct KnownLight {
    cv::Mat light;    ///< CV_32FC3: radiance over albedo
    cv::Mat coverage; ///< CV_32FC1; 0 where nothing is known
    cv::Mat normal, depth_m;
};

KnownLight known_light(PairPictures const& low, SurfaceView const& surfaces, gi::Camera const& camera,
                       cv::Rect region)
{
    cv::Size const size = low.coverage.size();
    KnownLight k{cv::Mat(size, CV_32FC3, cv::Scalar::all(0)), cv::Mat(size, CV_32FC1, cv::Scalar(0)),
                 cv::Mat(size, CV_32FC3, cv::Scalar::all(0)), cv::Mat(size, CV_32FC1, cv::Scalar(0))};
    cv::Mat albedo(size, CV_32FC3, cv::Scalar::all(0)), count(size, CV_32FC1, cv::Scalar(0));
    for (std::uint32_t pass = 0; pass < kPoints; ++pass) {
        FirstSurfaces const s = surfaces.seen(camera, size.width, size.height, pass, region, Surfaces::moving);
        albedo += s.albedo;
        k.normal += s.normal;
        k.depth_m += s.depth_m;
        count += cv::Mat(s.triangle >= 0) / 255; // 8 bits to floats
    }
    for (int y = region.y; y < region.br().y; ++y)
        for (int x = region.x; x < region.br().x; ++x) {
            float const n = count.at<float>(y, x), covered = low.coverage.at<float>(y, x);
            if (!(n > 0 && covered > 0)) continue;
            k.coverage.at<float>(y, x) = covered;
            k.depth_m.at<float>(y, x) /= n;
            cv::Vec3f& normal = k.normal.at<cv::Vec3f>(y, x);
            normal *= 1 / std::max(float(cv::norm(normal)), 1e-6f);
            cv::Vec3f const direct = low.direct.at<cv::Vec3f>(y, x), a = albedo.at<cv::Vec3f>(y, x);
            for (int c = 0; c < 3; ++c)
                k.light.at<cv::Vec3f>(y, x)[c] = direct[c] / covered / std::max(a[c] / n, kLeastAlbedo);
        }
    return k;
}

/// Of a surface at a point of the rendered picture; nothing where nobody near shows anything.
std::optional<cv::Vec3f> light_at(KnownLight const& known, double x, double y, cv::Vec3f const& normal,
                                  float depth_m)
{
    cv::Vec3f alike(0, 0, 0), any(0, 0, 0);
    float alike_weight = 0, any_weight = 0;
    int const x0 = int(std::floor(x)), y0 = int(std::floor(y));
    for (int reach = 1; reach <= kReach_px && alike_weight < 1e-3f; ++reach) {
        alike = any = cv::Vec3f(0, 0, 0);
        alike_weight = any_weight = 0;
        for (int j = y0 - reach + 1; j <= y0 + reach; ++j)
            for (int i = x0 - reach + 1; i <= x0 + reach; ++i) {
                if (i < 0 || j < 0 || i >= known.coverage.cols || j >= known.coverage.rows) continue;
                float const covered = known.coverage.at<float>(j, i);
                float const tent = float((1 - std::abs(i - x) / reach) * (1 - std::abs(j - y) / reach));
                if (!(covered > 0 && tent > 0)) continue;
                float const off = (known.depth_m.at<float>(j, i) - depth_m) / (0.02f * depth_m);
                float const unlike = 0.5f * off * off + 16 * (1 - normal.dot(known.normal.at<cv::Vec3f>(j, i)));
                cv::Vec3f const light = known.light.at<cv::Vec3f>(j, i);
                float const near = tent * covered, w = unlike < 20 ? near * std::exp(-unlike) : 0;
                alike += w * light;
                alike_weight += w;
                any += near * light;
                any_weight += near;
            }
    }
    if (alike_weight > 1e-6f) return alike * (1 / alike_weight);
    if (any_weight > 0) return any * (1 / any_weight);
    return std::nullopt;
}

} // namespace

cv::Rect around(cv::Mat const& mask, int by)
{
    cv::Rect r = cv::boundingRect(mask);
    if (r.empty()) return {};
    r -= cv::Point(by, by);
    r += cv::Size(2 * by, 2 * by);
    return r & cv::Rect({0, 0}, mask.size());
}

cv::Rect scaled(cv::Rect r, cv::Size from, cv::Size to)
{
    double const sx = double(to.width) / from.width, sy = double(to.height) / from.height;
    cv::Rect const s(cv::Point(int(std::floor(r.x * sx)), int(std::floor(r.y * sy))),
                     cv::Point(int(std::ceil(r.br().x * sx)), int(std::ceil(r.br().y * sy))));
    return s & cv::Rect({0, 0}, to);
}

void VirtualSurfaces::moved()
{
    all_.moved();
    if (virtual_) virtual_->moved();
}

SharpSurfaces VirtualSurfaces::at_size(PairPictures const& low, gi::Camera const& camera, cv::Size size,
                                       bool with_unoccluded)
{
    cv::Size const low_size = low.coverage.size();
    SharpSurfaces out;
    auto const nothing = [&] {
        return ar::DirectlySeen{cv::Mat(size, CV_32FC3, cv::Scalar::all(0)),
                                cv::Mat(size, CV_32FC1, cv::Scalar(0))};
    };
    out.seen = nothing();
    if (with_unoccluded) out.unoccluded = nothing();
    // A matte compares what is hidden within its windows.
    cv::Rect const low_region = around(low.coverage > 0, with_unoccluded ? 16 : 2);
    if (low_region.empty()) return out;
    KnownLight const known = known_light(low, all_, camera, low_region);
    cv::Rect const region = scaled(low_region, low_size, size);
    double const step_x = double(low_size.width) / size.width, step_y = double(low_size.height) / size.height;
    std::atomic<std::size_t> unlit = 0;
    auto const add = [&](ar::DirectlySeen& to, SurfaceView const& surfaces) {
        for (std::uint32_t pass = 0; pass < kPoints; ++pass) {
            FirstSurfaces const s = surfaces.seen(camera, size.width, size.height, pass, region, Surfaces::moving);
            cv::parallel_for_({region.y, region.br().y}, [&](cv::Range const& rows) {
                for (int y = rows.start; y < rows.end; ++y)
                    for (int x = region.x; x < region.br().x; ++x) {
                        if (s.triangle.at<int>(y, x) < 0) continue;
                        to.coverage.at<float>(y, x) += 1.0f / kPoints;
                        auto const light = light_at(known, (x + 0.5) * step_x - 0.5, (y + 0.5) * step_y - 0.5,
                                                    s.normal.at<cv::Vec3f>(y, x), s.depth_m.at<float>(y, x));
                        if (!light) {
                            ++unlit;
                            continue;
                        }
                        cv::Vec3f const albedo = s.albedo.at<cv::Vec3f>(y, x);
                        for (int c = 0; c < 3; ++c)
                            to.radiance.at<cv::Vec3f>(y, x)[c] +=
                                (*light)[c] * std::max(albedo[c], kLeastAlbedo) / kPoints;
                    }
            });
        }
    };
    add(out.seen, all_);
    if (with_unoccluded) {
        if (!virtual_) virtual_ = std::make_unique<SurfaceView>(world_, Surfaces::moving);
        add(out.unoccluded, *virtual_);
    }
    out.unlit = unlit;
    return out;
}

ar::SurfaceGuides guides_of(SurfaceView const& real, gi::Camera const& camera, cv::Size size, cv::Rect region,
                            int points)
{
    FirstSurfaces s = real.seen(camera, size.width, size.height, 0, region);
    for (std::uint32_t pass = 1; pass < std::uint32_t(points); ++pass)
        s.albedo += real.seen(camera, size.width, size.height, pass, region).albedo;
    return {s.normal, s.depth_m, s.albedo * (1.0 / points)};
}

} // namespace viewer
