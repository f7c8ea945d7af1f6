#include "ar/pose/estimate.h"

#include "ar/pose/candidates.h"
#include "ar/pose/expected_error.h"
#include "ar/pose/refine.h"
#include "gi/core/quantile.h"
#include "gi/core/rotation.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <random>

namespace ar {
namespace {

using SightedPoints = std::vector<SightedPoint>;

constexpr double kCoarseSigmas = 40; ///< an initial estimate agrees with points within this
constexpr double kLimitSigmas = 5;   ///< a refined pose disagrees with points beyond this
constexpr double kMostScale = 5;     ///< how much worse than their sigmas points may be
constexpr std::size_t kMarkerGuesses = 12;
constexpr int kRandomGuesses = 40;
constexpr std::size_t kRefinedGuesses = 4;
constexpr double kAmbiguous = 0.01;

std::map<int, SightedPoints> by_marker(SightedPoints const& points)
{
    std::map<int, SightedPoints> markers;
    for (SightedPoint const& p : points) markers[p.marker].push_back(p);
    return markers;
}

double size_px(SightedPoints const& points)
{
    glm::dvec2 low = points[0].pixel, high = low;
    for (SightedPoint const& p : points) {
        low = glm::min(low, p.pixel);
        high = glm::max(high, p.pixel);
    }
    return glm::length(high - low);
}

double truncated_cost(CameraModel const& camera, SightedPoints const& points, gi::RigidPose const& pose,
                      double limit)
{
    double sum = 0;
    for (SightedPoint const& p : points) {
        double const m = std::min(limit, miss_sigmas(camera, pose, p)) / limit;
        sum += m * m;
    }
    return sum;
}

void append(std::vector<gi::RigidPose>& to, std::vector<gi::RigidPose> const& more)
{
    to.insert(to.end(), more.begin(), more.end());
}

/// First guesses from all points; if not all agree, also from each of the larger markers,
/// and from few points drawn at random.
std::vector<gi::RigidPose> first_guesses(CameraModel const& camera, SightedPoints const& points,
                                         std::optional<gi::RigidPose> const& last)
{
    std::vector<gi::RigidPose> guesses = candidates(camera, points);
    if (last) guesses.push_back(*last);
    auto const some_disagree = [&] {
        return std::none_of(guesses.begin(), guesses.end(), [&](gi::RigidPose const& g) {
            return truncated_cost(camera, points, g, kCoarseSigmas) < 0.05 * double(points.size());
        });
    };
    if (!some_disagree()) return guesses;
    std::vector<SightedPoints> markers;
    for (auto& [unused, own] : by_marker(points)) markers.push_back(own);
    if (markers.size() > 1) {
        std::stable_sort(markers.begin(), markers.end(),
                         [](SightedPoints const& a, SightedPoints const& b) { return size_px(a) > size_px(b); });
        for (std::size_t i = 0; i < std::min(markers.size(), kMarkerGuesses); ++i)
            append(guesses, candidates(camera, markers[i]));
    }
    if (points.size() < 6 || !some_disagree()) return guesses;
    std::mt19937 random(1);
    for (int i = 0; i < kRandomGuesses; ++i) {
        SightedPoints few;
        std::sample(points.begin(), points.end(), std::back_inserter(few), 5, random);
        append(guesses, candidates(camera, few));
    }
    return guesses;
}

/// Ratio of the errors of the better half of the points to their sigmas, 1 to kMostScale.
double scale_of(CameraModel const& camera, SightedPoints const& points, gi::RigidPose const& pose)
{
    std::vector<double> misses;
    for (SightedPoint const& p : points) misses.push_back(miss_sigmas(camera, pose, p));
    return std::clamp(gi::median(std::move(misses)) / 1.1774, 1.0, kMostScale); // of a Rayleigh distribution
}

/// Returns the agreeing points, without markers of which half or more of the points disagree.
SightedPoints agreeing(CameraModel const& camera, SightedPoints const& points, gi::RigidPose const& pose,
                       double limit)
{
    SightedPoints kept;
    for (auto const& [unused, own] : by_marker(points)) {
        SightedPoints good;
        for (SightedPoint const& p : own)
            if (miss_sigmas(camera, pose, p) <= limit) good.push_back(p);
        if (2 * good.size() > own.size()) kept.insert(kept.end(), good.begin(), good.end());
    }
    return kept;
}

struct Agreed {
    Refined refined;
    SightedPoints points;
    double cost = 0; ///< truncated, over all points: what guesses are compared by
};

Agreed agree(CameraModel const& camera, SightedPoints const& points, gi::RigidPose const& guess)
{
    Agreed a;
    gi::RigidPose pose = guess;
    // With fewer than 6 points, any 3 fit exactly if the others count as outliers:
    // robust weights would choose such a pose.
    if (points.size() < 6)
        pose = refine(camera, points, pose).world_from_camera;
    else
        for (double const limits : {8.0, 3.0, 1.0})
            pose = refine(camera, points, pose, limits * kLimitSigmas * scale_of(camera, points, pose))
                       .world_from_camera;
    for (int round = 0; round < 4; ++round) {
        SightedPoints const kept = agreeing(camera, points, pose, kLimitSigmas * scale_of(camera, points, pose));
        bool const same = kept.size() == a.points.size();
        a.points = kept;
        if (kept.size() < 4) break;
        a.refined = refine(camera, kept, pose);
        pose = a.refined.world_from_camera;
        if (same && round > 0) break;
    }
    a.refined.world_from_camera = pose;
    a.cost = truncated_cost(camera, points, pose, kLimitSigmas * kMostScale);
    return a;
}

double chi2_scale(Agreed const& a)
{
    double const freedom = 2.0 * double(a.points.size()) - 6;
    return std::max(1.0, a.refined.chi2 / freedom);
}

double rms_px(CameraModel const& camera, SightedPoints const& points, gi::RigidPose const& pose)
{
    double sum = 0;
    for (SightedPoint const& p : points)
        if (auto const m = miss_px(camera, pose, p)) sum += glm::dot(*m, *m);
    return std::sqrt(sum / double(points.size()));
}

/// The best pose more than half a degree from the chosen one that the points of a plane allow. The mirrored one is
/// tried, too: that which IPPE finds for the first may fall together with it.
std::optional<Refined> second_pose(CameraModel const& camera, Agreed const& first, PointSet const& set)
{
    gi::RigidPose const& chosen = first.refined.world_from_camera;
    std::vector<gi::RigidPose> starts = candidates(camera, first.points);
    glm::dvec3 const sight = glm::normalize(set.centre_m - chosen.position);
    glm::dvec3 const normal = set.axes[2];
    glm::dvec3 const axis = glm::cross(normal, sight);
    if (double const sine = glm::length(axis); sine > 1e-6) {
        double const tilt = std::asin(std::min(1.0, sine)) * (glm::dot(normal, sight) < 0 ? -1 : 1);
        // Turning the camera about the set by twice the tilt shows the plane tilted the other way.
        glm::dquat const turn = gi::exp_rotation(axis / sine * (-2 * tilt));
        starts.push_back({set.centre_m + turn * (chosen.position - set.centre_m), turn * chosen.rotation});
    }
    std::optional<Refined> best;
    for (gi::RigidPose const& start : starts) {
        if (angle_between_deg(start.rotation, chosen.rotation) < 0.5) continue; // would find the first
        Refined const r = refine(camera, first.points, start);
        bool const ahead = std::all_of(first.points.begin(), first.points.end(), [&](SightedPoint const& p) {
            return miss_px(camera, r.world_from_camera, p).has_value();
        });
        bool const apart = angle_between_deg(r.world_from_camera.rotation, chosen.rotation) > 0.5;
        if (ahead && apart && r.covariance && (!best || r.chi2 < best->chi2)) best = r;
    }
    return best;
}

double distance(gi::RigidPose const& a, gi::RigidPose const& b, double extent_m)
{
    return angle_between_deg(a.rotation, b.rotation) +
           glm::degrees(glm::length(a.position - b.position) / std::max(1e-9, extent_m));
}

void decide(PoseEstimate& e, CameraModel const& camera, Agreed& chosen, std::optional<gi::RigidPose> const& last)
{
    PointSet const set = survey(chosen.points);
    if (set.shape != Shape::plane) return;
    auto const second = second_pose(camera, chosen, set);
    if (!second) return;
    Refined other = *second;
    double const scale = chi2_scale(chosen);
    auto const likelihood = [&] {
        return 1 / (1 + std::exp(std::clamp((other.chi2 - chosen.refined.chi2) / (2 * scale), -500.0, 500.0)));
    };
    double const likely = likelihood();
    bool swap = likely > 0.5;
    e.ambiguous = std::min(likely, 1 - likely) > kAmbiguous;
    if (e.ambiguous && last) {
        double const far = glm::length(set.centre_m - last->position);
        swap =
            distance(other.world_from_camera, *last, far) < distance(chosen.refined.world_from_camera, *last, far);
    }
    if (swap) std::swap(other, chosen.refined);
    e.other = other.world_from_camera;
    e.other_covariance = scale * *other.covariance;
    e.other_rms_px = rms_px(camera, chosen.points, other.world_from_camera);
    e.other_likelihood = likelihood();
}

void count(PoseEstimate& e, Sighting const& sighting, SightedPoints const& used)
{
    e.points_used = int(used.size());
    e.points_rejected = int(sighting.points.size() - used.size());
    for (auto const& [marker, unused] : by_marker(used)) e.markers_used.push_back(marker);
    for (auto const& [marker, unused] : by_marker(sighting.points))
        if (!std::binary_search(e.markers_used.begin(), e.markers_used.end(), marker))
            e.markers_rejected.push_back(marker);
}

bool is_usable(SightedPoint const& p)
{
    auto const finite = [](double v) { return std::abs(v) < 1e12; }; // false for NaN
    return finite(p.world_m.x) && finite(p.world_m.y) && finite(p.world_m.z) && finite(p.pixel.x) &&
           finite(p.pixel.y) && p.sigma_px > 0 && p.sigma_px < 1e6;
}

PoseEstimate failed(PoseFailure why, Sighting const& sighting)
{
    PoseEstimate e;
    e.failure = why;
    count(e, sighting, {});
    return e;
}

} // namespace

std::string name_of(PoseFailure failure)
{
    constexpr char const* names[]{"none", "too few points", "points on a line", "no agreement", "undetermined"};
    return names[std::size_t(failure)];
}

double confidence_of(double fit, double likelihood, glm::dvec3 const& rotation_sigma_deg)
{
    double const turn = std::max({rotation_sigma_deg.x, rotation_sigma_deg.y, rotation_sigma_deg.z});
    return fit * likelihood / (1 + turn * turn);
}

PoseEstimate estimate_pose(Sighting const& sighting, CameraModel const& camera,
                           std::optional<gi::RigidPose> const& last)
{
    SightedPoints points;
    std::copy_if(sighting.points.begin(), sighting.points.end(), std::back_inserter(points), is_usable);
    PointSet const all = survey(points);
    if (all.different < 4) return failed(PoseFailure::too_few_points, sighting);
    if (all.shape == Shape::line || all.shape == Shape::point) return failed(PoseFailure::on_a_line, sighting);
    // Precision is lost far from zero: compute relative to the points' centre.
    for (SightedPoint& p : points) p.world_m -= all.centre_m;
    std::optional<gi::RigidPose> near = last;
    if (near) near->position -= all.centre_m;

    std::vector<gi::RigidPose> guesses = first_guesses(camera, points, near);
    std::stable_sort(guesses.begin(), guesses.end(), [&](gi::RigidPose const& a, gi::RigidPose const& b) {
        return truncated_cost(camera, points, a, kCoarseSigmas) < truncated_cost(camera, points, b, kCoarseSigmas);
    });
    std::optional<Agreed> best;
    for (std::size_t i = 0; i < std::min(guesses.size(), kRefinedGuesses); ++i) {
        Agreed const a = agree(camera, points, guesses[i]);
        if (a.points.size() >= 4 && (!best || a.cost < best->cost)) best = a;
        if (best && best->cost < 0.05 * double(points.size())) break; // all points agree
    }
    if (!best || 2 * best->points.size() < points.size()) return failed(PoseFailure::no_agreement, sighting);
    PointSet const kept = survey(best->points);
    if (kept.different < 4 || kept.shape == Shape::line || !best->refined.covariance)
        return failed(PoseFailure::undetermined, sighting);

    PoseEstimate e;
    e.failure = PoseFailure::none;
    decide(e, camera, *best, near);
    Refined const& r = best->refined;
    e.world_from_camera = r.world_from_camera;
    e.rms_px = rms_px(camera, best->points, r.world_from_camera);
    e.distance_m = glm::length(kept.centre_m - r.world_from_camera.position);
    double const scale = chi2_scale(*best);
    e.covariance = scale * *r.covariance;
    for (int i = 0; i < 3; ++i) {
        e.position_sigma_m[i] = std::sqrt(e.covariance(i, i));
        e.rotation_sigma_deg[i] = glm::degrees(std::sqrt(e.covariance(3 + i, 3 + i)));
    }
    e.world_from_camera.position += all.centre_m;
    if (e.other) e.other->position += all.centre_m;
    count(e, sighting, best->points);
    double const own_likelihood = std::max(1 - e.other_likelihood, e.ambiguous && last ? 0.5 : 0);
    e.fit =
        double(e.points_used) / double(e.points_used + e.points_rejected) * std::min(1.0, 2 / std::sqrt(scale));
    e.confidence = confidence_of(e.fit, own_likelihood, e.rotation_sigma_deg);
    e.expected_error_m = expected_error(e);
    return e;
}

} // namespace ar
