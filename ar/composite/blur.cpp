#include "ar/composite/blur.h"

#include "gi/core/error.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>

namespace ar {
namespace {

/// CV_32FC4: the added light, and the coverage.
cv::Mat layer_of(RenderedPair const& pair)
{
    cv::Mat layer(pair.with.size(), CV_32FC4);
    layer.forEach<cv::Vec4f>([&](cv::Vec4f& v, int const* at) {
        float const a = pair.coverage.at<float>(at[0], at[1]);
        cv::Vec3f added = pair.with.at<cv::Vec3f>(at[0], at[1]);
        if (a < 1) added -= (1 - a) * pair.without.at<cv::Vec3f>(at[0], at[1]);
        v = {added[0], added[1], added[2], a};
        for (int c = 0; c < 4; ++c)
            if (!std::isfinite(v[c])) v = {0, 0, 0, 0}; // would spread
    });
    return layer;
}

RenderedPair pair_of(cv::Mat const& layer, RenderedPair const& pair)
{
    RenderedPair out{cv::Mat(layer.size(), CV_32FC3), pair.without, cv::Mat(layer.size(), CV_32FC1), {}};
    layer.forEach<cv::Vec4f>([&](cv::Vec4f const& v, int const* at) {
        float const a = std::clamp(v[3], 0.0f, 1.0f);
        cv::Vec3f with(v[0], v[1], v[2]);
        if (a < 1) with += (1 - a) * pair.without.at<cv::Vec3f>(at[0], at[1]);
        out.with.at<cv::Vec3f>(at[0], at[1]) = with;
        out.coverage.at<float>(at[0], at[1]) = a;
    });
    return out;
}

/// Integrals of a Gaussian over pixels, with the desired variance: integration changes the variance from sigma^2
/// (by +1/12 for wide ones, to 0 for narrow ones), so the matching Gaussian is searched.
cv::Mat spread_kernel(double sigma_px)
{
    int const reach = int(std::ceil(4 * sigma_px)) + 1;
    cv::Mat kernel(2 * reach + 1, 1, CV_64F);
    double narrow = 0, wide = sigma_px + 1;
    for (int i = 0; i < 40; ++i) {
        double const sigma = 0.5 * (narrow + wide);
        auto const up_to = [&](double x) { return 0.5 * std::erfc(-x / (std::numbers::sqrt2 * sigma)); };
        double sum = 0, variance = 0;
        for (int n = -reach; n <= reach; ++n) {
            double const part = up_to(n + 0.5) - up_to(n - 0.5);
            kernel.at<double>(n + reach) = part;
            sum += part;
            variance += part * n * n;
        }
        kernel *= 1 / sum;
        (variance / sum < sigma_px * sigma_px ? narrow : wide) = sigma;
    }
    return kernel;
}

} // namespace

double missing_blur_px(double camera_px, double rendered_px)
{
    return std::sqrt(std::max(0.0, camera_px * camera_px - rendered_px * rendered_px));
}

RenderedPair defocused(RenderedPair const& pair, double sigma_px)
{
    check(pair);
    if (!(sigma_px >= 0) || sigma_px > 20)
        throw gi::InputError("a blur with a sigma below 0 or above 20 pixels", "no calibrated camera has it",
                             "estimate the sharpness again");
    if (sigma_px == 0) return pair;
    cv::Mat const kernel = spread_kernel(sigma_px);
    cv::Mat layer = layer_of(pair);
    cv::sepFilter2D(layer, layer, -1, kernel, kernel, {-1, -1}, 0, cv::BORDER_REPLICATE);
    RenderedPair out = pair_of(layer, pair);
    if (!pair.direct.empty())
        cv::sepFilter2D(pair.direct, out.direct, -1, kernel, kernel, {-1, -1}, 0, cv::BORDER_REPLICATE);
    return out;
}

RenderedPair motion_blurred(RenderedPair const& pair, cv::Mat const& velocity_px, double longest_px)
{
    check(pair);
    cv::Size const size = pair.with.size();
    if (velocity_px.type() != CV_32FC2 || velocity_px.size() != size || !(longest_px > 0) || longest_px > 1000)
        throw gi::InputError("velocities of another size or type, or paths longer than 1000 pixels",
                             "each pixel needs its own",
                             "give CV_32FC2 of the pair's size, as image_velocity does");
    auto const path_at = [&](int x, int y) {
        cv::Vec2f v = velocity_px.at<cv::Vec2f>(y, x);
        if (!std::isfinite(v[0]) || !std::isfinite(v[1])) return cv::Vec2f(0, 0);
        double const length = std::hypot(v[0], v[1]);
        if (length > longest_px) v *= float(longest_px / length);
        return v;
    };
    // Longest motion near each tile: moving objects extend by half of it beyond their border.
    double longest = 0;
    for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x) longest = std::max(longest, cv::norm(path_at(x, y)));
    if (longest < 0.05) return pair;
    int const tile = std::max(1, int(std::ceil(longest / 2)));
    cv::Size const tiles((size.width + tile - 1) / tile, (size.height + tile - 1) / tile);
    cv::Mat of_tile(tiles, CV_32FC2, cv::Scalar(0, 0));
    for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x) {
            cv::Vec2f& best = of_tile.at<cv::Vec2f>(y / tile, x / tile);
            if (cv::Vec2f const v = path_at(x, y); v.dot(v) > best.dot(best)) best = v;
        }
    cv::Mat const layer = layer_of(pair);
    bool const parted = !pair.direct.empty();
    cv::Mat blurred(size, CV_32FC4), direct = parted ? cv::Mat(size, CV_32FC3) : cv::Mat();
    cv::parallel_for_({0, size.height}, [&](cv::Range const& rows) {
        for (int y = rows.start; y < rows.end; ++y)
            for (int x = 0; x < size.width; ++x) {
                cv::Vec2f path(0, 0);
                for (int j = std::max(0, y / tile - 1); j <= std::min(tiles.height - 1, y / tile + 1); ++j)
                    for (int i = std::max(0, x / tile - 1); i <= std::min(tiles.width - 1, x / tile + 1); ++i)
                        if (cv::Vec2f const v = of_tile.at<cv::Vec2f>(j, i); v.dot(v) > path.dot(path)) path = v;
                double const length = cv::norm(path);
                int const count = 2 * int(std::ceil(length / 2)) + 1; // odd, at most a pixel apart
                cv::Vec4f sum(0, 0, 0, 0);
                cv::Vec3f direct_sum(0, 0, 0);
                for (int k = 0; k < count; ++k) {
                    float const t = (float(k) + 0.5f) / float(count) - 0.5f;
                    float const at_x = std::clamp(float(x) + t * path[0], 0.0f, float(size.width - 1));
                    float const at_y = std::clamp(float(y) + t * path[1], 0.0f, float(size.height - 1));
                    int const x0 = int(at_x), y0 = int(at_y);
                    int const x1 = std::min(x0 + 1, size.width - 1), y1 = std::min(y0 + 1, size.height - 1);
                    float const fx = at_x - float(x0), fy = at_y - float(y0);
                    auto const between = [&](auto const& a, auto const& b, auto const& c, auto const& d) {
                        return (1 - fy) * ((1 - fx) * a + fx * b) + fy * ((1 - fx) * c + fx * d);
                    };
                    sum += between(layer.at<cv::Vec4f>(y0, x0), layer.at<cv::Vec4f>(y0, x1),
                                   layer.at<cv::Vec4f>(y1, x0), layer.at<cv::Vec4f>(y1, x1));
                    if (parted)
                        direct_sum +=
                            between(pair.direct.at<cv::Vec3f>(y0, x0), pair.direct.at<cv::Vec3f>(y0, x1),
                                    pair.direct.at<cv::Vec3f>(y1, x0), pair.direct.at<cv::Vec3f>(y1, x1));
                }
                if (parted) direct.at<cv::Vec3f>(y, x) = direct_sum * (1 / float(count));
                blurred.at<cv::Vec4f>(y, x) = sum * (1 / float(count));
            }
    });
    RenderedPair out = pair_of(blurred, pair);
    out.direct = direct;
    return out;
}

cv::Mat image_velocity(CameraModel const& camera, cv::Mat const& depth, gi::RigidPose const& before,
                       gi::RigidPose const& after)
{
    if (camera.lens != LensModel::pinhole || depth.type() != CV_32FC1 ||
        depth.size() != cv::Size(camera.size_px.x, camera.size_px.y))
        throw gi::InputError("velocities for a lens with distortion, or depth of another size or type",
                             "rendered pictures are of pinholes",
                             "give the pinhole and the depth that are rendered");
    cv::Mat velocity(depth.size(), CV_32FC2);
    gi::RigidPose const before_from_after = inverse(before) * after;
    velocity.forEach<cv::Vec2f>([&](cv::Vec2f& v, int const* at) {
        double const z = depth.at<float>(at[0], at[1]);
        glm::dvec3 const ray((at[1] - camera.cx) / camera.fx, (at[0] - camera.cy) / camera.fy, 1);
        glm::dvec3 const p = z > 0 ? before_from_after * (z * ray) : before_from_after.rotation * ray;
        if (!(p.z > 0)) {
            v = {0, 0};
            return;
        }
        v = {float(at[1] - (camera.fx * p.x / p.z + camera.cx)),
             float(at[0] - (camera.fy * p.y / p.z + camera.cy))};
    });
    return velocity;
}

} // namespace ar
