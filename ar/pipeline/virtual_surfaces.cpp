#include "ar/pipeline/virtual_surfaces.h"

#include <atomic>
#include <opencv2/imgproc.hpp>
#include <tbb/parallel_for.h>

namespace ar {
namespace {

constexpr int kSide = 2, kPoints = kSide * kSide; ///< of each pixel of the frame
constexpr float kLeastDivisor = 0.01f;
constexpr int kReach_px = 4; ///< radius of the search, rendered pixels

cv::Vec3f vector(gi::vec3 v) { return {v.x, v.y, v.z}; }

cv::Vec3f unit(cv::Vec3f const& v) { return v * (1 / std::max(std::sqrt(v.dot(v)), 1e-6f)); }

/// Pixels first..second - 1 of a line of the frame that lie in a pixel of a shorter one.
std::pair<int, int> pixels_in(int low, int low_length, int length)
{
    auto const edge = [&](int k) { return int((2LL * k * length + low_length) / (2LL * low_length)); };
    return {edge(low), edge(low + 1)};
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

void VirtualSurfaces::look(SurfaceView const& surfaces, gi::Camera const& camera, cv::Size size, cv::Rect region)
{
    surfaces.rasterise(camera, kSide * size.width, kSide * size.height,
                       {kSide * region.x, kSide * region.y, kSide * region.width, kSide * region.height}, raster_);
    pixels_.create(region.size());
    tbb::parallel_for(region.y, region.br().y, [&](int y) {
        for (int x = region.x; x < region.br().x; ++x) {
            VirtualPixel& p = pixels_(y - region.y, x - region.x) = VirtualPixel{};
            std::array<std::pair<gi::NearestTexel, gi::vec2>, kPoints> seen;
            float nearest = 0, farthest = gi::kInf; // reciprocals
            for (int k = 0; k < kPoints; ++k) {
                int const i = kSide * x + k % kSide, j = kSide * y + k / kSide;
                gi::NearestTexel const& texel = raster_.texel(i, j);
                if (texel.primitive == gi::kNoPrimitive || surfaces.is_still(texel)) continue;
                seen[std::size_t(p.points++)] = {texel, gi::vec2(float(i), float(j)) + 0.5f};
                nearest = std::max(nearest, texel.key);
                farthest = std::min(farthest, texel.key);
            }
            if (p.points == 0) continue;
            p.is_split = nearest > 1.02f * farthest;
            // One point suffices for a pixel inside a surface.
            bool const is_whole = p.points == kPoints && !p.is_split;
            if (is_whole) seen[0].second = float(kSide) * gi::vec2(float(x) + 0.5f, float(y) + 0.5f);
            int const looks = is_whole ? 1 : p.points;
            for (int k = 0; k < looks; ++k) {
                auto const& [texel, at] = seen[std::size_t(k)];
                FirstSurface const s = surfaces.surface_at(raster_, texel, at);
                p.normal += vector(s.normal);
                p.albedo += vector(s.albedo);
                p.depth_m += s.depth_m;
            }
            p.normal = unit(p.normal);
            p.albedo *= 1.0f / float(looks);
            p.depth_m /= float(looks);
        }
    });
}

void VirtualSurfaces::know(PairPictures const& low, cv::Size size, cv::Rect low_region, cv::Rect region)
{
    cv::Size const low_size = low.coverage.size();
    known_.create(low_size);
    std::fill(known_.values.begin(), known_.values.end(), PixelLight{});
    for (int y = low_region.y; y < low_region.br().y; ++y)
        for (int x = low_region.x; x < low_region.br().x; ++x) {
            float const covered = low.coverage.at<float>(y, x);
            if (!(covered > 0)) continue;
            auto const [left, right] = pixels_in(x, low_size.width, size.width);
            auto const [top, bottom] = pixels_in(y, low_size.height, size.height);
            PixelLight k;
            cv::Vec3f albedo;
            float points = 0;
            for (int j = std::max(top, region.y); j < std::min(bottom, region.br().y); ++j)
                for (int i = std::max(left, region.x); i < std::min(right, region.br().x); ++i) {
                    VirtualPixel const& p = pixels_(j - region.y, i - region.x);
                    auto const n = float(p.points);
                    points += n;
                    k.normal += n * p.normal;
                    k.depth_m += n * p.depth_m;
                    albedo += n * p.albedo;
                }
            if (!(points > 0)) continue;
            k.coverage = covered;
            k.normal = unit(k.normal);
            k.depth_m /= points;
            cv::Vec3f const direct = low.direct.at<cv::Vec3f>(y, x);
            for (int c = 0; c < 3; ++c)
                k.light[c] = direct[c] / covered / std::max(albedo[c] / points, kLeastDivisor);
            known_(y, x) = k;
        }
}

/// Light for a surface at a position of the rendered picture; nothing if no pixel nearby shows virtual objects.
std::optional<cv::Vec3f> VirtualSurfaces::light_at(cv::Vec2f place, cv::Vec3f const& normal, float depth_m) const
{
    cv::Vec3f alike, any;
    float alike_weight = 0, any_weight = 0;
    int const x0 = int(std::floor(place[0])), y0 = int(std::floor(place[1]));
    for (int reach = 1; reach <= kReach_px && alike_weight < 1e-3f; ++reach) {
        alike = any = cv::Vec3f(0, 0, 0);
        alike_weight = any_weight = 0;
        float const scale = 1.0f / float(reach);
        for (int j = std::max(y0 - reach + 1, 0); j <= std::min(y0 + reach, known_.rows - 1); ++j)
            for (int i = std::max(x0 - reach + 1, 0); i <= std::min(x0 + reach, known_.cols - 1); ++i) {
                PixelLight const& k = known_(j, i);
                float const tent =
                    (1 - std::abs(float(i) - place[0]) * scale) * (1 - std::abs(float(j) - place[1]) * scale);
                if (!(k.coverage > 0 && tent > 0)) continue;
                float const off = (k.depth_m - depth_m) / (0.02f * depth_m);
                float const unlike = 0.5f * off * off + 16 * (1 - normal.dot(k.normal));
                float const near = tent * k.coverage, w = unlike < 20 ? near * std::exp(-unlike) : 0;
                alike += w * k.light;
                alike_weight += w;
                any += near * k.light;
                any_weight += near;
            }
    }
    if (alike_weight > 1e-6f) return alike * (1 / alike_weight);
    if (any_weight > 0) return any * (1 / any_weight);
    return std::nullopt;
}

std::size_t VirtualSurfaces::light(SurfaceView const& surfaces, cv::Size low_size, cv::Size size, cv::Rect region,
                                   DirectlySeen& to) const
{
    float const step_x = float(low_size.width) / float(size.width),
                step_y = float(low_size.height) / float(size.height);
    std::atomic<std::size_t> unlit = 0;
    tbb::parallel_for(region.y, region.br().y, [&](int y) {
        for (int x = region.x; x < region.br().x; ++x) {
            VirtualPixel const& p = pixels_(y - region.y, x - region.x);
            if (p.points == 0) continue;
            to.coverage.at<float>(y, x) = float(p.points) / kPoints;
            cv::Vec2f const place((float(x) + 0.5f) * step_x - 0.5f, (float(y) + 0.5f) * step_y - 0.5f);
            auto const add = [&](cv::Vec3f const& normal, float depth_m, cv::Vec3f const& albedo, int points) {
                auto const light = light_at(place, normal, depth_m);
                if (!light) unlit += std::size_t(points);
                for (int c = 0; light && c < 3; ++c)
                    to.radiance.at<cv::Vec3f>(y, x)[c] +=
                        (*light)[c] * std::max(albedo[c], kLeastDivisor) * float(points) / kPoints;
            };
            if (!p.is_split) {
                add(p.normal, p.depth_m, p.albedo, p.points);
                continue;
            }
            for (int k = 0; k < kPoints; ++k) {
                int const i = kSide * x + k % kSide, j = kSide * y + k / kSide;
                gi::NearestTexel const& texel = raster_.texel(i, j);
                if (texel.primitive == gi::kNoPrimitive || surfaces.is_still(texel)) continue;
                FirstSurface const s = surfaces.surface_at(raster_, texel, gi::vec2(float(i), float(j)) + 0.5f);
                add(vector(s.normal), s.depth_m, vector(s.albedo), 1);
            }
        }
    });
    return unlit;
}

SharpSurfaces VirtualSurfaces::at_size(PairPictures const& low, gi::Camera const& camera, cv::Size size,
                                       bool with_unoccluded)
{
    cv::Size const low_size = low.coverage.size();
    auto const clear = [&](DirectlySeen& seen) {
        seen.radiance.create(size, CV_32FC3);
        seen.coverage.create(size, CV_32FC1);
        seen.radiance.setTo(cv::Scalar::all(0));
        seen.coverage.setTo(cv::Scalar(0));
    };
    out_.unlit = 0;
    clear(out_.seen);
    if (with_unoccluded) clear(out_.unoccluded);
    // Mattes need the hidden parts within their windows.
    cv::Rect const low_region = around(low.coverage > 0, with_unoccluded ? 16 : 2);
    if (low_region.empty()) return out_;
    cv::Rect const region = scaled(low_region, low_size, size);
    look(all_, camera, size, region);
    know(low, size, low_region, region);
    out_.unlit += light(all_, low_size, size, region, out_.seen);
    if (with_unoccluded) {
        if (!virtual_) virtual_ = std::make_unique<SurfaceView>(world_, Surfaces::moving);
        look(*virtual_, camera, size, region);
        out_.unlit += light(*virtual_, low_size, size, region, out_.unoccluded);
    }
    return out_;
}

void RealSurfaces::look(gi::Camera const& camera, cv::Size size, cv::Mat const& wanted)
{
    cv::Size const low_size = wanted.size();
    for (auto const& [guides, of] : {std::pair{&guides_, size}, {&low_, low_size}}) {
        guides->normal.create(of, CV_32FC3);
        guides->depth.create(of, CV_32FC1);
        guides->albedo.create(of, CV_32FC3);
    }
    cv::Rect const low_region = around(wanted, 0);
    if (low_region.empty()) return;
    real_.rasterise(camera, size.width, size.height, scaled(low_region, low_size, size), raster_);
    tbb::parallel_for(low_region.y, low_region.br().y, [&](int low_y) {
        auto const [top, bottom] = pixels_in(low_y, low_size.height, size.height);
        for (int low_x = low_region.x; low_x < low_region.br().x; ++low_x) {
            if (wanted.at<uchar>(low_y, low_x) == 0) continue;
            auto const [left, right] = pixels_in(low_x, low_size.width, size.width);
            cv::Vec3f albedo(0, 0, 0);
            for (int y = top; y < bottom; ++y)
                for (int x = left; x < right; ++x) {
                    gi::NearestTexel const& texel = raster_.texel(x, y);
                    FirstSurface s{gi::vec3(0), gi::vec3(0)};
                    if (texel.primitive != gi::kNoPrimitive)
                        s = real_.surface_at(raster_, texel, gi::vec2(float(x), float(y)) + 0.5f);
                    guides_.depth.at<float>(y, x) = s.depth_m;
                    guides_.normal.at<cv::Vec3f>(y, x) = vector(s.normal);
                    albedo += guides_.albedo.at<cv::Vec3f>(y, x) = vector(s.albedo);
                }
            int const x = (left + right) / 2, y = (top + bottom) / 2;
            low_.albedo.at<cv::Vec3f>(low_y, low_x) = albedo * (1 / float((right - left) * (bottom - top)));
            low_.depth.at<float>(low_y, low_x) = guides_.depth.at<float>(y, x);
            low_.normal.at<cv::Vec3f>(low_y, low_x) = guides_.normal.at<cv::Vec3f>(y, x);
        }
    });
}

} // namespace ar
