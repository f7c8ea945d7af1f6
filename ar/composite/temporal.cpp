#include "ar/composite/temporal.h"

#include "gi/core/error.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <mutex>
#include <opencv2/imgproc.hpp>
#include <optional>

namespace ar {
namespace {

/// The added light, and its extent.
struct Added {
    cv::Mat radiance; ///< CV_32FC3
    cv::Mat any;      ///< CV_8UC1, 255 within the radius of added light
    cv::Rect where;   ///< bounds of these pixels
};

Added added_by(RenderedPair const& pair, int radius)
{
    Added added;
    added.radiance.create(pair.with.size(), CV_32FC3);
    added.any.create(pair.with.size(), CV_8UC1);
    cv::parallel_for_({0, pair.with.rows}, [&](cv::Range const& rows) {
        for (int y = rows.start; y < rows.end; ++y) {
            auto const* const with = pair.with.ptr<cv::Vec3f>(y);
            auto const* const without = pair.without.ptr<cv::Vec3f>(y);
            auto const* const coverage = pair.coverage.ptr<float>(y);
            auto* const v = added.radiance.ptr<cv::Vec3f>(y);
            auto* const any = added.any.ptr<uchar>(y);
            for (int x = 0; x < pair.with.cols; ++x) {
                v[x] = coverage[x] < 1 ? cv::Vec3f(with[x] - (1 - coverage[x]) * without[x]) : with[x];
                any[x] = v[x] != cv::Vec3f(0, 0, 0) ? 255 : 0;
            }
        }
    });
    int const side = 2 * radius + 1;
    cv::dilate(added.any, added.any, cv::getStructuringElement(cv::MORPH_RECT, {side, side}));
    added.where = cv::boundingRect(added.any);
    return added;
}

/// Means around each pixel, of the part where something is added.
struct Neighbourhood {
    cv::Mat mean, mean_square; ///< CV_32FC3; of floats: equal values may get 3e-4 of themselves as deviation
};

Neighbourhood around(Added const& added, int radius)
{
    cv::Mat finite = added.radiance(added.where).clone(); // a NaN would spoil all sums after it
    finite.forEach<cv::Vec3f>([](cv::Vec3f& v, int const*) {
        if (!is_finite(v)) v = {0, 0, 0};
    });
    Neighbourhood n;
    cv::Size const box(2 * radius + 1, 2 * radius + 1);
    cv::boxFilter(finite, n.mean, CV_32F, box, {-1, -1}, true, cv::BORDER_REPLICATE);
    cv::boxFilter(finite.mul(finite), n.mean_square, CV_32F, box, {-1, -1}, true, cv::BORDER_REPLICATE);
    return n;
}

/// Reprojects a pixel's surface to the previous frame.
class PlaceBefore {
public:
    /// @param still  take each pixel for the same as before
    PlaceBefore(CameraModel const& camera, gi::RigidPose const& before_from_now, bool still)
        : camera_(camera),
          turn_(glm::mat3_cast(before_from_now.rotation)),
          shift_(before_from_now.position),
          still_(still)
    {
    }
    /// @param z metres along the axis, 0 = infinitely far. @return pixel and the depth then; depth below 0: unseen
    glm::dvec3 operator()(int x, int y, double z) const
    {
        if (still_) return {x, y, z};
        glm::dvec3 p = turn_ * glm::dvec3((x - camera_.cx) / camera_.fx, (y - camera_.cy) / camera_.fy, 1);
        if (z > 0) p = z * p + shift_;
        if (!(p.z > 0)) return {0, 0, -1};
        return {camera_.fx * p.x / p.z + camera_.cx, camera_.fy * p.y / p.z + camera_.cy, z > 0 ? p.z : 0};
    }

private:
    CameraModel camera_;
    glm::dmat3 turn_;
    glm::dvec3 shift_;
    bool still_;
};

/// Approximate largest motion of pixels: by the rotation, and by the translation for the nearest surface.
double motion_px(CameraModel const& camera, gi::RigidPose const& before_from_now, cv::Mat const& depth)
{
    double nearest_m = std::numeric_limits<double>::infinity(), shift_m = glm::length(before_from_now.position);
    if (shift_m > 0)
        for (int y = 0; y < depth.rows; ++y)
            for (int x = 0; x < depth.cols; ++x)
                if (float const z = depth.at<float>(y, x); z > 0) nearest_m = std::min(nearest_m, double(z));
    // A rotation by a small angle moves pixels at the border of a wide picture more than in its middle.
    double const wide =
        1 + glm::dot(glm::dvec2(camera.size_px), glm::dvec2(camera.size_px)) / (4 * camera.fx * camera.fx);
    glm::dquat const& q = before_from_now.rotation;
    double const angle = 2 * std::asin(std::min(1.0, glm::length(glm::dvec3(q.x, q.y, q.z))));
    return camera.fx * (angle * wide + (shift_m > 0 ? shift_m / nearest_m * wide : 0));
}

} // namespace

TemporalFilter::TemporalFilter(CameraModel const& camera, TemporalSettings const& settings)
    : camera_(camera), settings_(settings)
{
    if (camera.lens != LensModel::pinhole)
        throw gi::InputError("a temporal filter for a lens with distortion", "rendered pictures are of pinholes",
                             "filter before Warp");
    if (!(settings.weight > 0) || !(settings.weight <= 1) || !(settings.gamma >= 0) || settings.radius_px < 1)
        throw gi::InputError(fmt::format("a temporal filter of weight {}, gamma {} and radius {}", settings.weight,
                                         settings.gamma, settings.radius_px),
                             "they must be in (0, 1], at least 0 and at least 1", "leave them as they are");
}

void TemporalFilter::forget() { added_ = cv::Mat(); }

RenderedPair TemporalFilter::operator()(RenderedPair const& pair, cv::Mat const& depth, gi::RigidPose const& pose,
                                        SceneChange change)
{
    constexpr float kMostFrames = 256;
    constexpr double kStill_px = 0.02;
    gi::RigidPose const before_from_now = inverse(world_from_camera_) * pose;
    // History that is looked up between pixels again and again would be blurred.
    bool const same_view = !added_.empty() && motion_px(camera_, before_from_now, depth) < kStill_px;
    bool const is_still = change == SceneChange::none && same_view;
    cv::Size const size(camera_.size_px.x, camera_.size_px.y);
    check(pair, size);
    if (depth.type() != CV_32FC1 || depth.size() != size)
        throw gi::InputError("depth for the temporal filter has another size or type",
                             "surfaces cannot be tracked",
                             "give metres along the axis as floats, of the size of the pair");
    Added const added = added_by(pair, settings_.radius_px);
    cv::Rect const where = added.where;
    counts_ = {};
    RenderedPair out{pair.with.clone(), pair.without, pair.coverage, pair.direct};
    cv::Mat filtered = added.radiance.clone(), frames(size, CV_32FC1, cv::Scalar(1));
    if (added_.empty()) {
        counts_.fresh = filtered.total();
    } else {
        counts_.followed = filtered.total() - std::size_t(where.area()); // nothing is there, as before
        PlaceBefore const place_before(camera_, before_from_now, same_view);
        struct History {
            cv::Vec3f added;
            float frames;
        };
        auto const history = [&](int x, int y, float a) -> std::optional<History> {
            glm::dvec3 const before = place_before(x, y, depth.at<float>(y, x));
            double const z = before.z;
            if (!(z >= 0 && before.x > -1 && before.y > -1 && before.x < size.width && before.y < size.height))
                return std::nullopt;
            int const x0 = int(std::floor(before.x)), y0 = int(std::floor(before.y));
            float const fx = float(before.x - x0), fy = float(before.y - y0);
            cv::Vec3f sum(0, 0, 0);
            float weight = 0, least_frames = kMostFrames;
            for (int j = 0; j < 2; ++j)
                for (int i = 0; i < 2; ++i) {
                    float const w = (i ? fx : 1 - fx) * (j ? fy : 1 - fy);
                    cv::Point const q(x0 + i, y0 + j);
                    if (!(w > 0) || q.x < 0 || q.y < 0 || q.x >= size.width || q.y >= size.height) continue;
                    if (!(std::abs(coverage_.at<float>(q) - a) <= settings_.coverage_tolerance)) continue;
                    double const d = depth_.at<float>(q);
                    if ((d > 0) != (z > 0) || std::abs(d - z) > settings_.depth_tolerance * z) continue;
                    cv::Vec3f const v = added_.at<cv::Vec3f>(q);
                    if (!is_finite(v)) continue;
                    sum += w * v;
                    weight += w;
                    least_frames = std::min(least_frames, frames_.at<float>(q));
                }
            if (!(weight > 1e-3f)) return std::nullopt;
            return History{sum * (1 / weight), least_frames};
        };
        Neighbourhood const near = where.empty() ? Neighbourhood{} : around(added, settings_.radius_px);
        std::mutex adding;
        cv::parallel_for_({where.y, where.y + where.height}, [&](cv::Range const& rows) {
            TemporalCounts counts;
            for (int y = rows.start; y < rows.end; ++y)
                for (int x = where.x; x < where.x + where.width; ++x) {
                    if (added.any.at<uchar>(y, x) == 0) {
                        ++counts.followed;
                        continue;
                    }
                    cv::Vec3f const now = added.radiance.at<cv::Vec3f>(y, x);
                    float const a = pair.coverage.at<float>(y, x);
                    auto const h = history(x, y, a);
                    if (!h || !is_finite(now)) {
                        ++counts.fresh;
                        continue;
                    }
                    ++counts.followed;
                    cv::Vec3f const m = near.mean.at<cv::Vec3f>(y - where.y, x - where.x);
                    cv::Vec3f const square = near.mean_square.at<cv::Vec3f>(y - where.y, x - where.x);
                    cv::Vec3f v;
                    float const seen = is_still ? std::min(h->frames + 1, kMostFrames) : 1.0f;
                    float const weight = is_still ? 1 / seen : settings_.weight;
                    frames.at<float>(y, x) = seen;
                    for (int c = 0; c < 3; ++c) {
                        float const reach = settings_.gamma * std::sqrt(std::max(0.0f, square[c] - m[c] * m[c]));
                        float held = h->added[c];
                        if (!is_still && (held < m[c] - reach || held > m[c] + reach)) {
                            ++counts.clipped;
                            held = held < m[c] ? m[c] - reach : m[c] + reach;
                        }
                        v[c] = held + weight * (now[c] - held);
                    }
                    if (v == now) continue; // unchanged values keep all their bits
                    filtered.at<cv::Vec3f>(y, x) = v;
                    out.with.at<cv::Vec3f>(y, x) =
                        a < 1 ? cv::Vec3f(v + (1 - a) * pair.without.at<cv::Vec3f>(y, x)) : v;
                }
            std::lock_guard const lock(adding);
            counts_.followed += counts.followed;
            counts_.fresh += counts.fresh;
            counts_.clipped += counts.clipped;
        });
    }
    added_ = filtered;
    frames_ = frames;
    coverage_ = pair.coverage.clone();
    depth_ = depth.clone();
    if (!same_view) world_from_camera_ = pose; // small motions add up
    return out;
}

} // namespace ar
