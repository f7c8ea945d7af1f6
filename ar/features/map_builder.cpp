#include "ar/features/map_builder.h"

#include <algorithm>
#include <cmath>

namespace ar {
namespace {

constexpr double kSameFeature_px = 2; ///< a new feature this near to a track counts as the same
constexpr double kApart_px = 6;       ///< from all tracks, to begin a new one
constexpr double kSigma_px = 0.5;     ///< of a sighting
constexpr int kAlike = 30;            ///< bits: a descriptor adds nothing
constexpr double kMerged = 0.004;     ///< points nearer than this share of their distance that look alike are one
constexpr int kMergedBits = 60;

} // namespace

bool MapBuilder::has_moved(gi::RigidPose const& a, gi::RigidPose const& b, double m, double deg) const
{
    return glm::length(a.position - b.position) > m || angle_between_deg(a.rotation, b.rotation) > deg;
}

void MapBuilder::add(cv::Mat const& gray, gi::RigidPose const& world_from_camera)
{
    ++counts_.pictures;
    follow(gray, world_from_camera);
    if (key_ && !has_moved(*key_, world_from_camera, settings_.key_m, settings_.key_deg)) return;
    key_ = world_from_camera;
    ++counts_.key_pictures;
    look(gray, world_from_camera);
}

void MapBuilder::skip()
{
    for (Track const& t : tracks_) end(t);
    tracks_.clear();
    key_.reset();
}

void MapBuilder::follow(cv::Mat const& gray, gi::RigidPose const& world_from_camera)
{
    std::vector<glm::dvec2> pixels;
    for (Track const& t : tracks_) pixels.push_back(t.pixel);
    auto const found = flow_.next(gray, pixels);
    std::vector<Track> going_on;
    for (std::size_t k = 0; k < tracks_.size(); ++k) {
        Track& t = tracks_[k];
        if (!found[k]) {
            end(t);
            continue;
        }
        t.pixel = *found[k];
        if (t.sightings.size() < settings_.sightings &&
            has_moved(t.sightings.back().world_from_camera, world_from_camera, settings_.sighting_m,
                      settings_.sighting_deg))
            t.sightings.push_back({world_from_camera, t.pixel});
        going_on.push_back(std::move(t));
    }
    tracks_ = std::move(going_on);
}

void MapBuilder::look(cv::Mat const& gray, gi::RigidPose const& world_from_camera)
{
    PictureFeatures const features = find_features(gray, settings_.features);
    std::size_t const known = tracks_.size();
    for (std::size_t k = 0; k < features.pixels.size(); ++k) {
        double nearest_px = kApart_px;
        Track* nearest = nullptr;
        for (std::size_t t = 0; t < known; ++t)
            if (double const d = glm::length(tracks_[t].pixel - features.pixels[k]); d < nearest_px) {
                nearest_px = d;
                nearest = &tracks_[t];
            }
        Descriptor const& d = features.descriptors[k];
        if (nearest == nullptr) {
            tracks_.push_back({{{world_from_camera, features.pixels[k]}}, features.pixels[k], {d}});
            ++counts_.tracks;
        } else if (nearest_px < kSameFeature_px && nearest->descriptors.size() < kMostDescriptors &&
                   std::all_of(nearest->descriptors.begin(), nearest->descriptors.end(),
                               [&](Descriptor const& e) { return hamming(d, e) > kAlike; })) {
            nearest->descriptors.push_back(d);
        }
    }
}

std::optional<MapPoint> MapBuilder::triangulated(Track const& track)
{
    if (track.sightings.size() < settings_.fewest_sightings) {
        ++counts_.short_lived;
        return std::nullopt;
    }
    // The point nearest to all rays, then Gauss-Newton of the reprojection error.
    glm::dmat3 sum(0);
    glm::dvec3 right(0);
    std::vector<glm::dvec3> rays;
    for (Sighted const& s : track.sightings) {
        auto const d = direction_of(camera_, s.pixel);
        if (!d) continue;
        glm::dvec3 const ray = s.world_from_camera.rotation * *d;
        rays.push_back(ray);
        glm::dmat3 const across = glm::dmat3(1) - glm::outerProduct(ray, ray);
        sum += across;
        right += across * s.world_from_camera.position;
    }
    double widest = 1;
    for (std::size_t i = 0; i < rays.size(); ++i)
        for (std::size_t j = 0; j < i; ++j) widest = std::min(widest, glm::dot(rays[i], rays[j]));
    if (rays.size() < 2 || widest > std::cos(glm::radians(settings_.least_parallax_deg))) {
        ++counts_.no_parallax;
        return std::nullopt;
    }
    glm::dvec3 point = glm::inverse(sum) * right;
    glm::dmat3 information(0);
    double rms_px = 1e9;
    for (int round = 0; round < 6; ++round) {
        information = glm::dmat3(0);
        glm::dvec3 gradient(0);
        double square = 0;
        std::size_t n = 0;
        for (Sighted const& s : track.sightings) {
            gi::RigidPose const camera_from_world = inverse(s.world_from_camera);
            auto const at = project(camera_, camera_from_world * point);
            if (!at) continue;
            glm::dvec2 const miss = *at - s.pixel;
            double const step = 1e-5 * glm::length(s.world_from_camera.position - point);
            glm::dvec3 jx(0), jy(0);
            bool whole = true;
            for (int c = 0; c < 3; ++c) {
                glm::dvec3 moved = point;
                moved[c] += step;
                auto const q = project(camera_, camera_from_world * moved);
                if (!q) {
                    whole = false;
                    break;
                }
                jx[c] = (q->x - at->x) / step;
                jy[c] = (q->y - at->y) / step;
            }
            if (!whole) continue;
            information += glm::outerProduct(jx, jx) + glm::outerProduct(jy, jy);
            gradient += jx * miss.x + jy * miss.y;
            square += glm::dot(miss, miss);
            ++n;
        }
        rms_px = n > 0 && 2 * n > track.sightings.size() ? std::sqrt(square / double(n)) : 1e9;
        if (!(rms_px < 1e8) || !(std::abs(glm::determinant(information)) > 1e-30)) break;
        point -= glm::inverse(information) * gradient;
    }
    if (!(rms_px < settings_.most_rms_px)) {
        ++counts_.bad_fit;
        return std::nullopt;
    }
    glm::dmat3 const covariance = glm::inverse(information);
    // Sightings along one track share their feature's error: they count as three.
    double const shared = std::sqrt(double(track.sightings.size()) / 3);
    double const sigma_m = kSigma_px * shared * std::sqrt(covariance[0][0] + covariance[1][1] + covariance[2][2]);
    return MapPoint{point, sigma_m, track.descriptors};
}

void MapBuilder::add_merged(MapPoint point, double distance_m)
{
    for (std::size_t const near : grid_.near(point.world_m, kMerged * distance_m)) {
        MapPoint& p = map_.points[near];
        bool const alike = std::any_of(p.descriptors.begin(), p.descriptors.end(), [&](Descriptor const& d) {
            return hamming(d, point.descriptors.front()) < kMergedBits;
        });
        if (!alike) continue;
        ++counts_.merged;
        double const a = 1 / (p.sigma_m * p.sigma_m), b = 1 / (point.sigma_m * point.sigma_m);
        p.world_m = (a * p.world_m + b * point.world_m) / (a + b);
        grid_.move(near, p.world_m);
        p.sigma_m = std::min(p.sigma_m, point.sigma_m);
        for (Descriptor const& d : point.descriptors)
            if (p.descriptors.size() < kMostDescriptors &&
                std::all_of(p.descriptors.begin(), p.descriptors.end(),
                            [&](Descriptor const& e) { return hamming(d, e) > kAlike; }))
                p.descriptors.push_back(d);
        return;
    }
    grid_.add(point.world_m);
    map_.points.push_back(std::move(point));
}

void MapBuilder::end(Track const& t)
{
    auto p = triangulated(t);
    if (!p) return;
    double const away_m = glm::length(t.sightings.front().world_from_camera.position - p->world_m);
    if (away_m > 0 && std::isfinite(away_m) && p->sigma_m > 0 && p->sigma_m <= 0.05 * away_m)
        add_merged(std::move(*p), away_m);
    else
        ++counts_.bad_fit;
}

FeatureMap const& MapBuilder::finish()
{
    skip();
    return map_;
}

} // namespace ar
