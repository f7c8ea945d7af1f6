#include "ar/pose/focal_check.h"

#include "ar/pose/candidates.h"
#include "ar/pose/refine.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace ar {
namespace {

constexpr double kMost_sigmas = 60; ///< limit of one point's error
constexpr std::size_t kFewestPoints = 8;

struct Cost {
    double sigmas2 = 0, px2 = 0; ///< means over the points
};

/// Of the best pose that a camera of this focal length can have.
Cost cost_of(CameraModel const& camera, std::vector<SightedPoint> const& points)
{
    Cost best{kMost_sigmas * kMost_sigmas, 0};
    bool found = false;
    for (gi::RigidPose const& start : candidates(camera, points)) {
        gi::RigidPose const pose = refine(camera, points, start, 20).world_from_camera;
        Cost c;
        for (SightedPoint const& p : points) {
            double const miss = std::min(kMost_sigmas, miss_sigmas(camera, pose, p));
            c.sigmas2 += miss * miss / double(points.size());
            c.px2 += miss * miss * p.sigma_px * p.sigma_px / double(points.size());
        }
        if (!found || c.sigmas2 < best.sigmas2) best = c;
        found = true;
    }
    return best;
}

CameraModel with_scale(CameraModel camera, double scale)
{
    camera.fx *= scale;
    camera.fy *= scale;
    return camera;
}

} // namespace

std::optional<FocalFinding> contradicted_focal_length(CameraModel const& camera,
                                                      std::vector<Sighting> const& views)
{
    constexpr int kSteps = 10;           // to each side
    constexpr double kBetter = 4;        // in squared residuals
    constexpr double kLeast_sigmas2 = 9; // smaller residuals need no explanation
    constexpr double kLeastChange = 0.03;
    constexpr std::size_t kFewestViews = 3;
    if (camera.lens == LensModel::stmap) return std::nullopt; // its table has no focal length
    std::vector<std::vector<SightedPoint>> usable;
    for (Sighting const& v : views) {
        if (v.points.size() < kFewestPoints) continue;
        std::vector<SightedPoint> points = v.points;
        glm::dvec3 const centre = survey(points).centre_m;
        for (SightedPoint& p : points) p.world_m -= centre;
        usable.push_back(std::move(points));
    }
    if (usable.size() < kFewestViews) return std::nullopt;
    auto const total = [&](double scale) {
        Cost sum;
        CameraModel const other = with_scale(camera, scale);
        for (auto const& points : usable) {
            Cost const c = cost_of(other, points);
            sum.sigmas2 += c.sigmas2 / double(usable.size());
            sum.px2 += c.px2 / double(usable.size());
        }
        return sum;
    };
    Cost const own = total(1);
    if (own.sigmas2 < kLeast_sigmas2) return std::nullopt;
    auto const scale_at = [](double step) { return std::exp2(step / kSteps); };
    double at = 0;
    Cost best = own;
    for (double const step : {1.0, 0.25, 0.0625}) {
        double const middle = at, width = step == 1 ? kSteps : 4 * step;
        for (double s = middle - width; s <= middle + width + 1e-9; s += step)
            if (Cost const c = total(scale_at(s)); c.sigmas2 < best.sigmas2) {
                best = c;
                at = s;
            }
    }
    double const scale = scale_at(at);
    bool const is_inside = std::abs(at) < kSteps - 0.5; // at the ends the views do not tell
    if (!is_inside || std::abs(scale - 1) < kLeastChange || best.sigmas2 * kBetter > own.sigmas2)
        return std::nullopt;
    return FocalFinding{scale, std::sqrt(own.px2), std::sqrt(best.px2), int(usable.size())};
}

std::string describe(FocalFinding const& f, CameraModel const& camera)
{
    return fmt::format(
        "the pictures of the markers fit a focal length of {:.0f} px ({:.2f} px RMS), the calibration "
        "has {:.0f} ({:.2f} px RMS): is it of this camera, zoom and picture size?",
        f.scale * camera.fx, f.best_px, camera.fx, f.own_px);
}

} // namespace ar
