#include "ar/composite/upsample.h"

#include "gi/core/error.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

namespace ar {
namespace {

void check(SurfaceGuides const& g, cv::Size size, SurfaceGuides const& other)
{
    auto const require = [&](cv::Mat const& picture, int type, bool needed, char const* name) {
        if (picture.empty() ? !needed : picture.type() == type && picture.size() == size) return;
        throw gi::InputError(
            fmt::format("the guide '{}' has {} x {} pixels of type {}", name, picture.cols, picture.rows,
                        cv::typeToString(picture.type())),
            fmt::format("{} x {} of {} are needed", size.width, size.height, cv::typeToString(type)),
            "give each guide at both resolutions, or at none");
    };
    require(g.normal, CV_32FC3, !other.normal.empty(), "normal");
    require(g.depth, CV_32FC1, !other.depth.empty(), "depth");
    require(g.albedo, CV_32FC3, !other.albedo.empty(), "albedo");
}

constexpr float kLeastAlbedo = 0.01f;
constexpr float kEnough = 0.1f; ///< of the bilinear weights is on the pixel's own surface

cv::Vec3f at_least(cv::Vec3f v)
{
    for (int c = 0; c < 3; ++c) v[c] = std::max(v[c], kLeastAlbedo);
    return v;
}

/// Share of each low-resolution pixel that shows the place and is separable from objects; 0 = unknown.
cv::Mat share_known(RenderedPair const& low)
{
    constexpr float kMostCovered = 0.75f; // above this, the uncovered part is mostly noise
    cv::Mat share(low.coverage.size(), CV_32FC1);
    share.forEach<float>([&](float& s, int const* at) {
        float const a = low.coverage.at<float>(at[0], at[1]);
        s = !(a > 0) ? 1 : !low.direct.empty() && a <= kMostCovered ? 1 - a : 0;
    });
    return share;
}

/// Similarity of the surfaces in a low-resolution and a full-resolution pixel.
float likeness(SurfaceGuides const& guides, cv::Point full, SurfaceGuides const& low_guides, cv::Point low,
               UpsampleSettings const& settings)
{
    float unlike = 0;
    if (!guides.depth.empty()) {
        float const z = guides.depth.at<float>(full), l = low_guides.depth.at<float>(low);
        if ((z > 0) != (l > 0)) return 0;
        if (z > 0) {
            float const off = (l - z) / (z * float(settings.depth_tolerance));
            unlike += 0.5f * off * off;
        }
    }
    if (!guides.normal.empty())
        unlike += float(settings.normal_power) *
                  (1 - guides.normal.at<cv::Vec3f>(full).dot(low_guides.normal.at<cv::Vec3f>(low)));
    return unlike < 20 ? std::exp(-unlike) : 0;
}

} // namespace

RenderedPair upsampled(RenderedPair const& low, SurfaceGuides const& low_guides, DirectlySeen const& seen,
                       SurfaceGuides const& guides, UpsampleSettings const& settings, cv::Mat const& without_full,
                       UpsampleCounts* counts)
{
    check(low);
    cv::Size const size = seen.coverage.size(), low_size = low.with.size();
    check(RenderedPair{seen.radiance, without_full.empty() ? seen.radiance : without_full, seen.coverage}, size);
    check(guides, size, low_guides);
    check(low_guides, low_size, guides);

    // Change of incident light on the surfaces. The uncovered part of partly covered pixels is used, too:
    // shadows are darkest where objects touch the ground.
    cv::Mat change = low.with - low.without;
    cv::Mat const known = share_known(low);
    if (!low.direct.empty())
        change.forEach<cv::Vec3f>([&](cv::Vec3f& v, int const* at) {
            float const rest = known.at<float>(at[0], at[1]);
            if (rest > 0 && rest < 1)
                v = (low.with.at<cv::Vec3f>(at[0], at[1]) - low.direct.at<cv::Vec3f>(at[0], at[1])) * (1 / rest) -
                    low.without.at<cv::Vec3f>(at[0], at[1]);
        });
    if (!low_guides.albedo.empty())
        change.forEach<cv::Vec3f>([&](cv::Vec3f& v, int const* at) {
            cv::Vec3f const albedo = at_least(low_guides.albedo.at<cv::Vec3f>(at[0], at[1]));
            for (int c = 0; c < 3; ++c)
                if (v[c] != 0) v[c] /= albedo[c]; // where nothing changes, guides may be undefined
        });

    // Most of a frame has no change within reach.
    cv::Mat changed(low_size, CV_8UC1);
    changed.forEach<uchar>([&](uchar& any, int const* at) {
        bool const covered = low.coverage.at<float>(at[0], at[1]) > 0;
        any = covered || change.at<cv::Vec3f>(at[0], at[1]) != cv::Vec3f(0, 0, 0) ? 255 : 0;
    });
    cv::dilate(changed, changed, cv::getStructuringElement(cv::MORPH_RECT, {5, 5}));

    RenderedPair out;
    out.coverage = seen.coverage;
    out.direct = seen.radiance;
    if (without_full.empty())
        cv::resize(low.without, out.without, size, 0, 0, cv::INTER_LINEAR);
    else
        out.without = without_full;
    out.with.create(size, CV_32FC3);
    std::atomic<std::size_t> without_guide = 0, no_sample = 0;
    double const step_x = double(low_size.width) / size.width, step_y = double(low_size.height) / size.height;
    cv::parallel_for_({0, size.height}, [&](cv::Range const& rows) {
        for (int y = rows.start; y < rows.end; ++y)
            for (int x = 0; x < size.width; ++x) {
                double const lx = (x + 0.5) * step_x - 0.5, ly = (y + 0.5) * step_y - 0.5;
                int const x0 = int(std::floor(lx)), y0 = int(std::floor(ly));
                float const a = seen.coverage.at<float>(y, x);
                if (!changed.at<uchar>(std::clamp(y0, 0, low_size.height - 1),
                                       std::clamp(x0, 0, low_size.width - 1)) &&
                    !(a > 0)) {
                    out.with.at<cv::Vec3f>(y, x) = out.without.at<cv::Vec3f>(y, x);
                    continue;
                }
                cv::Vec3f guided(0, 0, 0), plain(0, 0, 0);
                float guided_weight = 0, plain_weight = 0;
                auto const add = [&](int i, int j, float near) {
                    if (i < 0 || j < 0 || i >= low_size.width || j >= low_size.height || !(near > 0)) return;
                    near *= known.at<float>(j, i);
                    if (!(near > 0)) return;
                    cv::Vec3f const v = change.at<cv::Vec3f>(j, i);
                    float const w = near * likeness(guides, {x, y}, low_guides, {i, j}, settings);
                    guided += w * v;
                    guided_weight += w;
                    plain += near * v;
                    plain_weight += near;
                };
                float const fx = float(lx - x0), fy = float(ly - y0);
                for (int k = 0; k < 4; ++k)
                    add(x0 + k % 2, y0 + k / 2, (k % 2 ? fx : 1 - fx) * (k / 2 ? fy : 1 - fy));
                // If no direct neighbour shows the surface, try the next ones.
                if (guided_weight < kEnough)
                    for (int k = 0; k < 16; ++k) {
                        int const i = x0 - 1 + k % 4, j = y0 - 1 + k / 4;
                        float const tent = float((1 - std::abs(i - lx) / 2) * (1 - std::abs(j - ly) / 2));
                        add(i, j, kEnough * tent);
                    }
                cv::Vec3f light(0, 0, 0);
                if (!guides.depth.empty() && !(guides.depth.at<float>(y, x) > 0)) {
                    // No pixel gives a value here, so nothing changes.
                } else if (guided_weight > 1e-6f)
                    light = guided * (1 / guided_weight);
                else if (plain_weight > 0) {
                    light = plain * (1 / plain_weight);
                    ++without_guide;
                } else
                    ++no_sample;
                if (!guides.albedo.empty()) {
                    cv::Vec3f const albedo = at_least(guides.albedo.at<cv::Vec3f>(y, x));
                    light = light.mul(albedo);
                }
                cv::Vec3f const place = out.without.at<cv::Vec3f>(y, x) + light;
                out.with.at<cv::Vec3f>(y, x) =
                    a > 0 ? seen.radiance.at<cv::Vec3f>(y, x) + (1 - std::min(a, 1.0f)) * place : place;
            }
    });
    if (counts) *counts = {without_guide, no_sample};
    return out;
}

} // namespace ar
