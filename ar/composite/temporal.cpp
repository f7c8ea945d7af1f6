#include "ar/composite/temporal.h"

#include "ar/base/error.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <mutex>
#include <opencv2/imgproc.hpp>
#include <optional>

namespace ar {
namespace {

cv::Mat added_by(RenderedPair const& pair)
{
    cv::Mat added(pair.with.size(), CV_32FC3);
    added.forEach<cv::Vec3f>([&](cv::Vec3f& v, int const* at) {
        float const a = pair.coverage.at<float>(at[0], at[1]);
        v = pair.with.at<cv::Vec3f>(at[0], at[1]);
        if (a < 1) v -= (1 - a) * pair.without.at<cv::Vec3f>(at[0], at[1]);
    });
    return added;
}

bool is_finite(cv::Vec3f const& v) { return std::isfinite(v[0]) && std::isfinite(v[1]) && std::isfinite(v[2]); }

/// Around each pixel of one picture.
struct Neighbourhood {
    cv::Mat mean, deviation; ///< CV_32FC3
    cv::Mat any;             ///< CV_8UC1: 0 where nothing is added; running sums leave rounding errors there
};

Neighbourhood around(cv::Mat const& added, int radius)
{
    Neighbourhood n;
    cv::Mat finite = added.clone(); // a NaN would spoil all sums after it
    n.any.create(added.size(), CV_8UC1);
    finite.forEach<cv::Vec3f>([&](cv::Vec3f& v, int const* at) {
        n.any.at<uchar>(at[0], at[1]) = v != cv::Vec3f(0, 0, 0) ? 255 : 0;
        if (!is_finite(v)) v = {0, 0, 0};
    });
    cv::Size const box(2 * radius + 1, 2 * radius + 1);
    cv::dilate(n.any, n.any, cv::getStructuringElement(cv::MORPH_RECT, box));
    n.mean = cv::Mat::zeros(added.size(), CV_32FC3);
    n.deviation = cv::Mat::zeros(added.size(), CV_32FC3);
    cv::Rect const where = cv::boundingRect(n.any);
    if (where.empty()) return n;
    cv::Mat const part = finite(where); // filters read beyond it
    cv::Mat mean, variance;             // of floats: equal values may get 3e-4 of themselves as deviation
    cv::boxFilter(part, mean, CV_32F, box, {-1, -1}, true, cv::BORDER_REPLICATE);
    cv::sqrBoxFilter(part, variance, CV_32F, box, {-1, -1}, true, cv::BORDER_REPLICATE);
    mean.copyTo(n.mean(where));
    variance.forEach<cv::Vec3f>([&](cv::Vec3f const& square, int const* at) {
        cv::Vec3f const m = mean.at<cv::Vec3f>(at[0], at[1]);
        cv::Vec3f& to = n.deviation.at<cv::Vec3f>(where.y + at[0], where.x + at[1]);
        for (int c = 0; c < 3; ++c) to[c] = std::sqrt(std::max(0.0f, square[c] - m[c] * m[c]));
    });
    return n;
}

} // namespace

TemporalFilter::TemporalFilter(CameraModel const& camera, TemporalSettings const& settings)
    : camera_(camera), settings_(settings)
{
    if (camera.lens != LensModel::pinhole)
        throw InputError("a temporal filter for a lens with distortion", "rendered pictures are of pinholes",
                         "filter before Warp");
    if (!(settings.weight > 0) || !(settings.weight <= 1) || !(settings.gamma >= 0) || settings.radius_px < 1)
        throw InputError(fmt::format("a temporal filter of weight {}, gamma {} and radius {}", settings.weight,
                                     settings.gamma, settings.radius_px),
                         "they must be in (0, 1], at least 0 and at least 1", "leave them as they are");
}

void TemporalFilter::forget() { added_ = cv::Mat(); }

RenderedPair TemporalFilter::operator()(RenderedPair const& pair, cv::Mat const& depth, Pose const& pose)
{
    cv::Size const size(camera_.size_px.x, camera_.size_px.y);
    check(pair, size);
    if (depth.type() != CV_32FC1 || depth.size() != size)
        throw InputError("depth for the temporal filter has another size or type", "surfaces cannot be followed",
                         "give metres along the axis as floats, of the size of the pair");
    cv::Mat const added = added_by(pair);
    Neighbourhood const near = around(added, settings_.radius_px);
    Pose const before_from_now = inverse(world_from_camera_) * pose;
    bool const still =
        before_from_now.position_m == glm::dvec3(0) && std::abs(before_from_now.rotation.w) > 1 - 1e-15;

    // Where the surface of a pixel was, if the frame before shows it.
    auto const place_before = [&](int x, int y, float z) -> std::optional<std::pair<glm::dvec2, double>> {
        if (still) return std::pair{glm::dvec2(x, y), double(z)};
        glm::dvec3 const ray((x - camera_.cx) / camera_.fx, (y - camera_.cy) / camera_.fy, 1);
        glm::dvec3 const p = z > 0 ? before_from_now * (double(z) * ray) : before_from_now.rotation * ray;
        if (!(p.z > 0)) return std::nullopt;
        return std::pair{glm::dvec2(camera_.fx * p.x / p.z + camera_.cx, camera_.fy * p.y / p.z + camera_.cy),
                         z > 0 ? p.z : 0.0};
    };
    auto const history = [&](int x, int y) -> std::optional<cv::Vec3f> {
        auto const before = place_before(x, y, depth.at<float>(y, x));
        if (!before) return std::nullopt;
        auto const [at, z] = *before;
        if (!(at.x > -1 && at.y > -1 && at.x < size.width && at.y < size.height)) return std::nullopt;
        int const x0 = int(std::floor(at.x)), y0 = int(std::floor(at.y));
        double const fx = at.x - x0, fy = at.y - y0;
        cv::Vec3d sum(0, 0, 0);
        double weight = 0;
        float const a = pair.coverage.at<float>(y, x);
        for (int j = 0; j < 2; ++j)
            for (int i = 0; i < 2; ++i) {
                double const w = (i ? fx : 1 - fx) * (j ? fy : 1 - fy);
                cv::Point const q(x0 + i, y0 + j);
                if (!(w > 0) || q.x < 0 || q.y < 0 || q.x >= size.width || q.y >= size.height) continue;
                if (!(std::abs(coverage_.at<float>(q) - a) <= settings_.coverage_tolerance)) continue;
                double const d = depth_.at<float>(q);
                if ((d > 0) != (z > 0) || std::abs(d - z) > settings_.depth_tolerance * z) continue;
                cv::Vec3f const v = added_.at<cv::Vec3f>(q);
                if (!is_finite(v)) continue;
                sum += w * cv::Vec3d(v);
                weight += w;
            }
        if (!(weight > 1e-3)) return std::nullopt;
        return cv::Vec3f(sum * (1 / weight));
    };

    counts_ = {};
    cv::Mat filtered = added.clone();
    std::mutex adding;
    if (!added_.empty())
        cv::parallel_for_({0, size.height}, [&](cv::Range const& rows) {
            TemporalCounts counts;
            for (int y = rows.start; y < rows.end; ++y)
                for (int x = 0; x < size.width; ++x) {
                    cv::Vec3f& v = filtered.at<cv::Vec3f>(y, x);
                    if (near.any.at<uchar>(y, x) == 0) {
                        ++counts.followed;
                        continue;
                    }
                    cv::Vec3f const m = near.mean.at<cv::Vec3f>(y, x), s = near.deviation.at<cv::Vec3f>(y, x);
                    auto const h = history(x, y);
                    if (!h || !is_finite(v)) {
                        ++counts.fresh;
                        continue;
                    }
                    ++counts.followed;
                    for (int c = 0; c < 3; ++c) {
                        float const reach = settings_.gamma * s[c];
                        float held = (*h)[c];
                        if (held < m[c] - reach || held > m[c] + reach) {
                            ++counts.clipped;
                            held = held < m[c] ? m[c] - reach : m[c] + reach;
                        }
                        v[c] = held + settings_.weight * (v[c] - held);
                    }
                }
            std::lock_guard const lock(adding);
            counts_.followed += counts.followed;
            counts_.fresh += counts.fresh;
            counts_.clipped += counts.clipped;
        });
    else
        counts_.fresh = added.total();
    added_ = filtered;
    coverage_ = pair.coverage.clone();
    depth_ = depth.clone();
    world_from_camera_ = pose;

    RenderedPair out{pair.with.clone(), pair.without, pair.coverage, pair.direct};
    out.with.forEach<cv::Vec3f>([&](cv::Vec3f& v, int const* at) {
        cv::Vec3f const changed = filtered.at<cv::Vec3f>(at[0], at[1]), now = added.at<cv::Vec3f>(at[0], at[1]);
        if (changed == now) return; // what is unchanged keeps all its bits
        float const a = pair.coverage.at<float>(at[0], at[1]);
        v = a < 1 ? changed + (1 - a) * pair.without.at<cv::Vec3f>(at[0], at[1]) : changed;
    });
    return out;
}

} // namespace ar
