#include "ar/features/feature_tracker.h"

#include "ar/pose/refine.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <opencv2/calib3d.hpp>
#include <opencv2/features2d.hpp>

namespace ar {
namespace {

constexpr double kFlow_px = 0.05;     ///< error that following adds per picture
constexpr double kAway_sigmas = 5;    ///< a followed feature with a larger residual is dropped
constexpr double kLikeTheNext = 0.8;  ///< ratio of distances to the best and to the next point (Lowe 2004)
constexpr double kSamePlace_m = 0.01; ///< points nearer than this do not compete
constexpr double kInlier_px = 5;
constexpr int kGrid_px = 16;
constexpr int kMatchedAtOnce = 64; ///< features, between looks at stop requests
constexpr std::size_t kFewestInliers = 12;

} // namespace

FeatureTracker::FeatureTracker(FeatureMap map, CameraModel const& camera, FeatureTrackerSettings const& settings)
    : map_(std::move(map)), camera_(camera), settings_(settings)
{
    check_size(map_, "the map");
    for (std::size_t k = 0; k < map_.points.size(); ++k)
        for (std::size_t d = 0; d < map_.points[k].descriptors.size(); ++d) point_of_.push_back(int(k));
    descriptors_.create(int(point_of_.size()), 32, CV_8UC1);
    int row = 0;
    for (MapPoint const& p : map_.points)
        for (Descriptor const& d : p.descriptors) std::memcpy(descriptors_.ptr(row++), d.data(), d.size());
}

PoseEstimate FeatureTracker::next(double time_s, cv::Mat const& gray, std::optional<gi::RigidPose> const& expected,
                                  Sighting& seen, gi::StopRequest const* stop)
{
    ++counts_.pictures;
    follow(gray, expected);
    PoseEstimate e;
    if (followed_.size() >= settings_.fewest) e = estimate(expected ? expected : last_, seen);
    bool const is_lost = !e.found() || e.markers_used.size() < settings_.fewest;
    if (is_lost || ++since_look_ >= settings_.look_every || followed_.size() < settings_.followed / 2) {
        PictureFeatures const features = find_features(gray);
        since_look_ = 0;
        if (is_lost) {
            followed_.clear();
            e = relocate(features, stop) ? estimate({}, seen) : PoseEstimate();
            e.found() ? ++counts_.relocated : ++counts_.not_relocated;
            if (e.found()) {
                recognised_s_ = time_s;
            } else {
                followed_.clear();
                seen = {};
            }
        }
        if (e.found()) {
            ++counts_.looked;
            std::size_t const recognised = look(features, e.world_from_camera);
            e = estimate(e.world_from_camera, seen);
            if (e.found() && recognised >= settings_.fewest) recognised_s_ = time_s;
        }
    }
    last_.reset();
    flow_s_ = std::max(0.0, time_s - recognised_s_);
    if (!e.found()) return e;
    last_ = e.world_from_camera;
    std::erase_if(followed_, [&](Followed const& f) {
        MapPoint const& p = map_.points[std::size_t(f.point)];
        return miss_sigmas(camera_, *last_, {p.world_m, f.pixel, f.point, f.sigma_px}) > kAway_sigmas;
    });
    double const drift = std::exp(-flow_s_ / settings_.trusted_flow_s);
    e.fit *= drift;
    e.confidence *= drift;
    return e;
}

void FeatureTracker::follow(cv::Mat const& gray, std::optional<gi::RigidPose> const& expected)
{
    std::vector<glm::dvec2> pixels, guesses;
    for (Followed const& f : followed_) {
        pixels.push_back(f.pixel);
        glm::dvec3 const at = map_.points[std::size_t(f.point)].world_m;
        auto const before = last_ ? project(camera_, inverse(*last_) * at) : std::nullopt;
        auto const now = expected ? project(camera_, inverse(*expected) * at) : std::nullopt;
        glm::dvec2 const way = before && now ? *now - *before : glm::dvec2(0);
        guesses.push_back(f.pixel + (glm::length(way) < 0.2 * camera_.size_px.x ? way : glm::dvec2(0)));
    }
    auto const found = flow_.next(gray, pixels, guesses);
    std::vector<Followed> kept;
    for (std::size_t k = 0; k < followed_.size(); ++k)
        if (found[k]) kept.push_back({followed_[k].point, *found[k], std::hypot(followed_[k].sigma_px, kFlow_px)});
    followed_ = std::move(kept);
}

Sighting FeatureTracker::sighting() const
{
    Sighting s;
    for (Followed const& f : followed_) {
        MapPoint const& p = map_.points[std::size_t(f.point)];
        double const away_m = last_ ? std::max(0.01, glm::length(last_->position - p.world_m)) : 1;
        s.points.push_back({p.world_m, f.pixel, f.point, std::hypot(f.sigma_px, p.sigma_m * camera_.fx / away_m)});
    }
    s.markers_seen = int(followed_.size());
    return s;
}

PoseEstimate FeatureTracker::estimate(std::optional<gi::RigidPose> const& expected, Sighting& seen)
{
    seen = sighting();
    return estimate_pose(seen, camera_, expected);
}

/// Recognises features near where the pose predicts them: corrects those that are followed, and adds others.
std::size_t FeatureTracker::look(PictureFeatures const& features, gi::RigidPose const& world_from_camera)
{
    int const columns = camera_.size_px.x / kGrid_px + 1, rows = camera_.size_px.y / kGrid_px + 1;
    std::vector<std::vector<std::pair<int, glm::dvec2>>> cells(std::size_t(columns) * std::size_t(rows));
    auto const cell_of = [](double v, int n) { return std::clamp(int(v / kGrid_px), 0, n - 1); };
    gi::RigidPose const camera_from_world = inverse(world_from_camera);
    for (std::size_t k = 0; k < map_.points.size(); ++k) {
        auto const at = project(camera_, camera_from_world * map_.points[k].world_m);
        if (!at || at->x < 0 || at->y < 0 || at->x >= camera_.size_px.x || at->y >= camera_.size_px.y) continue;
        cells[std::size_t(cell_of(at->y, rows) * columns + cell_of(at->x, columns))].emplace_back(int(k), *at);
    }
    struct Match {
        int bits;
        int point;
        std::size_t feature;
    };
    std::vector<Match> matches;
    for (std::size_t f = 0; f < features.pixels.size(); ++f) {
        glm::dvec2 const at = features.pixels[f];
        Match best{settings_.alike_bits, -1, f};
        for (int y = cell_of(at.y - settings_.near_px, rows); y <= cell_of(at.y + settings_.near_px, rows); ++y)
            for (int x = cell_of(at.x - settings_.near_px, columns);
                 x <= cell_of(at.x + settings_.near_px, columns); ++x)
                for (auto const& [point, pixel] : cells[std::size_t(y * columns + x)]) {
                    if (glm::length(pixel - at) > settings_.near_px) continue;
                    for (Descriptor const& d : map_.points[std::size_t(point)].descriptors)
                        if (int const bits = hamming(d, features.descriptors[f]); bits < best.bits)
                            best = {bits, point, f};
                }
        if (best.point >= 0) matches.push_back(best);
    }
    std::stable_sort(matches.begin(), matches.end(),
                     [](Match const& a, Match const& b) { return a.bits < b.bits; });
    std::vector<char> used(map_.points.size(), 0);
    std::size_t recognised = 0;
    for (Match const& m : matches) {
        if (used[std::size_t(m.point)]) continue;
        used[std::size_t(m.point)] = 1;
        ++recognised;
        Followed const seen{m.point, features.pixels[m.feature], features.sigma_px[m.feature]};
        auto const known = std::find_if(followed_.begin(), followed_.end(),
                                        [&](Followed const& f) { return f.point == m.point; });
        if (known == followed_.end()) {
            if (followed_.size() < settings_.followed) followed_.push_back(seen);
        } else {
            // The mean by variance.
            double const a = 1 / (known->sigma_px * known->sigma_px), b = 1 / (seen.sigma_px * seen.sigma_px);
            known->pixel = (a * known->pixel + b * seen.pixel) / (a + b);
            known->sigma_px = std::max(0.3, std::sqrt(1 / (a + b)));
        }
    }
    return recognised;
}

/// Recognises features by their descriptors alone, and keeps those that agree with one pose.
bool FeatureTracker::relocate(PictureFeatures const& features, gi::StopRequest const* stop)
{
    if (features.pixels.size() < kFewestInliers || point_of_.size() < kFewestInliers) return false;
    cv::Mat query(int(features.descriptors.size()), 32, CV_8UC1);
    for (int k = 0; k < query.rows; ++k)
        std::memcpy(query.ptr(k), features.descriptors[std::size_t(k)].data(), 32);
    cv::BFMatcher const matcher(cv::NORM_HAMMING);
    std::vector<std::vector<cv::DMatch>> matches;
    for (int from = 0; from < query.rows; from += kMatchedAtOnce) {
        if (stop != nullptr && stop->requested()) return false;
        std::vector<std::vector<cv::DMatch>> some;
        matcher.knnMatch(query.rowRange(from, std::min(from + kMatchedAtOnce, query.rows)), descriptors_, some, 4);
        for (auto& nearest : some) {
            for (cv::DMatch& m : nearest) m.queryIdx += from;
            matches.push_back(std::move(nearest));
        }
    }
    std::vector<cv::Point3d> world;
    std::vector<cv::Point2d> picture;
    std::vector<Followed> guesses;
    for (auto const& nearest : matches) {
        if (nearest.empty() || nearest[0].distance > float(settings_.alike_bits)) continue;
        int const point = point_of_[std::size_t(nearest[0].trainIdx)];
        MapPoint const& p = map_.points[std::size_t(point)];
        bool const unsure = std::any_of(nearest.begin() + 1, nearest.end(), [&](cv::DMatch const& m) {
            int const other = point_of_[std::size_t(m.trainIdx)];
            return other != point && nearest[0].distance > kLikeTheNext * m.distance &&
                   glm::length(map_.points[std::size_t(other)].world_m - p.world_m) > kSamePlace_m;
        });
        if (unsure) continue;
        std::size_t const f = std::size_t(nearest[0].queryIdx);
        auto const d = direction_of(camera_, features.pixels[f]);
        if (!d || d->z < 0.2) continue;
        world.emplace_back(p.world_m.x, p.world_m.y, p.world_m.z);
        picture.emplace_back(d->x / d->z, d->y / d->z);
        guesses.push_back({point, features.pixels[f], features.sigma_px[f]});
    }
    if (guesses.size() < kFewestInliers) return false;
    cv::setRNGSeed(1); // the same picture gives the same pose
    cv::Mat turn, shift;
    std::vector<int> inliers;
    bool const found = cv::solvePnPRansac(world, picture, cv::Matx33d::eye(), cv::noArray(), turn, shift, false,
                                          500, float(kInlier_px / camera_.fx), 0.999, inliers, cv::SOLVEPNP_EPNP);
    if (!found || inliers.size() < kFewestInliers) return false;
    followed_.clear();
    std::vector<char> used(map_.points.size(), 0);
    for (int const k : inliers) {
        Followed const& g = guesses[std::size_t(k)];
        if (used[std::size_t(g.point)] || followed_.size() >= settings_.followed) continue;
        used[std::size_t(g.point)] = 1;
        followed_.push_back(g);
    }
    return followed_.size() >= kFewestInliers;
}

} // namespace ar
