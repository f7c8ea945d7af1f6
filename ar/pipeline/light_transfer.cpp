#include "ar/pipeline/light_transfer.h"

#include "gi/core/rng.h"

#include <cmath>
#include <numbers>
#include <tbb/parallel_for.h>

namespace ar {
namespace {

constexpr int kAround = 32;           ///< rays from each point to find other surfaces
constexpr std::size_t kPlaces = 1500; ///< most places that light by way of surfaces is computed at
constexpr int kBounces = 4;

/// Two axes that are perpendicular to a direction.
std::pair<gi::vec3, gi::vec3> across(gi::vec3 n)
{
    gi::vec3 const side =
        glm::normalize(glm::cross(n, std::abs(n.y) < 0.9f ? gi::vec3(0, 1, 0) : gi::vec3(1, 0, 0)));
    return {side, glm::cross(n, side)};
}

gi::RayQuery leaving(ReceivingPoint const& p, gi::vec3 towards)
{
    float const side = glm::dot(towards, p.geometric_normal) > 0 ? p.clearance : -p.clearance;
    gi::RayQuery q;
    q.ray = {p.position + side * p.geometric_normal, towards};
    return q;
}

/// Cosine to a direction; 0 if the surface itself blocks it.
float cosine_of(ReceivingPoint const& p, gi::vec3 towards)
{
    float const cosine = glm::dot(p.normal, towards);
    return cosine > 0 && glm::dot(p.geometric_normal, towards) > 0 ? cosine : 0;
}

gi::vec3 clamped(gi::vec3 albedo) { return glm::clamp(albedo, gi::vec3(0), gi::vec3(0.98f)); }

} // namespace

ReceivingPoint receiving_point(gi::ShadingPoint const& p)
{
    return {p.position, p.frame.normal, p.geometric_normal, p.clearance};
}

LightTransfer::LightTransfer(gi::World const& world, LightBasis const& basis)
    : world_(world), view_(gi::view(world)), basis_(basis), visibility_(world, true, 0)
{
}

cv::Mat LightTransfer::direct(std::vector<ReceivingPoint> const& points) const
{
    int const k = basis_.count();
    cv::Mat out(int(points.size()), k, CV_32F, cv::Scalar(0));
    tbb::parallel_for(std::size_t(0), points.size(), [&](std::size_t i) {
        ReceivingPoint const& p = points[i];
        gi::Pcg32 rng = gi::Pcg32::for_path(5, std::uint32_t(i), 0);
        std::vector<gi::RayQuery> queries;
        std::vector<std::pair<int, float>> which;
        auto const radius = float(basis_.cell_radius_rad());
        for (int j = 0; j < k; ++j) {
            // A random direction in the cell: neighbouring points average over the cell.
            gi::vec3 const d(basis_.direction(j));
            auto const [side, up] = across(d);
            float const turn = 2 * std::numbers::pi_v<float> * rng.uniform(),
                        r = radius * std::sqrt(rng.uniform());
            gi::vec3 const towards = glm::normalize(d + r * (std::cos(turn) * side + std::sin(turn) * up));
            float const cosine = cosine_of(p, towards);
            if (!(cosine > 0)) continue;
            queries.push_back(leaving(p, towards));
            queries.back().seed = rng.next();
            which.emplace_back(j, cosine);
        }
        std::vector<std::uint8_t> blocked(queries.size());
        visibility_.occluded(queries, blocked);
        for (std::size_t n = 0; n < which.size(); ++n)
            if (!blocked[n]) out.ptr<float>(int(i))[which[n].first] = which[n].second * float(basis_.cell_sr());
    });
    return out;
}

std::vector<float> LightTransfer::of_disc(std::vector<ReceivingPoint> const& points, glm::dvec3 towards,
                                          double half_angle_rad) const
{
    std::vector<float> out(points.size(), 0.0f);
    int const rays = half_angle_rad < 0.01 ? 1 : 12;
    auto const [side, up] = across(gi::vec3(towards));
    std::vector<gi::vec3> directions;
    for (int k = 0; k < rays; ++k) { // a spiral of equal areas
        auto const r = rays == 1 ? 0.0f : float(std::tan(half_angle_rad) * std::sqrt((k + 0.5) / rays));
        float const turn = 2.39996f * float(k);
        directions.push_back(
            glm::normalize(gi::vec3(towards) + r * (std::cos(turn) * side + std::sin(turn) * up)));
    }
    std::vector<gi::RayQuery> queries;
    std::vector<std::pair<std::size_t, float>> which;
    for (std::size_t i = 0; i < points.size(); ++i)
        for (gi::vec3 const& d : directions)
            if (float const cosine = cosine_of(points[i], d); cosine > 0) {
                queries.push_back(leaving(points[i], d));
                queries.back().seed = std::uint32_t(i);
                which.emplace_back(i, cosine / float(rays));
            }
    std::vector<std::uint8_t> blocked(queries.size());
    visibility_.occluded(queries, blocked);
    for (std::size_t n = 0; n < which.size(); ++n)
        if (!blocked[n]) out[which[n].first] += which[n].second;
    return out;
}

std::vector<std::vector<LightTransfer::FoundHit>>
LightTransfer::look_around(std::vector<ReceivingPoint> const& points, std::uint32_t seed) const
{
    std::vector<std::vector<FoundHit>> out(points.size());
    tbb::parallel_for(std::size_t(0), points.size(), [&](std::size_t i) {
        ReceivingPoint const& p = points[i];
        gi::Pcg32 rng = gi::Pcg32::for_path(seed, std::uint32_t(i), 1);
        auto const [side, up] = across(p.normal);
        gi::vec2 const shift = rng.uniform2();
        std::vector<gi::RayQuery> queries;
        for (int k = 0; k < kAround; ++k) {
            float const u = (float(k) + shift.x) / kAround;
            float const turn = 2 * std::numbers::pi_v<float> * (0.618034f * float(k) + shift.y);
            float const r = std::sqrt(u);
            queries.push_back(leaving(p, glm::normalize(r * (std::cos(turn) * side + std::sin(turn) * up) +
                                                        std::sqrt(std::max(0.0f, 1 - u)) * p.normal)));
            queries.back().seed = rng.next();
        }
        std::vector<gi::Hit> hits(queries.size());
        visibility_.nearest(queries, hits);
        for (std::size_t k = 0; k < hits.size(); ++k) {
            if (hits[k].triangle == gi::kNoTriangle) continue;
            gi::ShadingPoint const s =
                gi::shading_point(view_, hits[k].triangle, hits[k].barycentric, queries[k].ray.direction);
            out[i].push_back({receiving_point(s), clamped(gi::albedo(s.bsdf))});
        }
    });
    return out;
}

std::vector<std::vector<LightTransfer::MetPlace>>
LightTransfer::by_places(std::vector<std::vector<FoundHit>> const& hits, std::vector<ReceivingPoint> const& places)
{
    std::vector<std::vector<MetPlace>> out(hits.size());
    if (places.empty()) return out;
    tbb::parallel_for(std::size_t(0), hits.size(), [&](std::size_t i) {
        for (FoundHit const& h : hits[i]) {
            int best = -1;
            float least = gi::kInf;
            for (std::size_t k = 0; k < places.size(); ++k) {
                gi::vec3 const away = places[k].position - h.point.position;
                // The other side of a thin board is not near, however near it is.
                float const d =
                    glm::dot(away, away) * (glm::dot(places[k].normal, h.point.normal) > 0.7f ? 1 : 1e4f);
                if (d < least) {
                    least = d;
                    best = int(k);
                }
            }
            if (best >= 0) out[i].push_back({best, h.albedo});
        }
    });
    return out;
}

std::array<cv::Mat, 3> LightTransfer::by_surfaces(std::vector<ReceivingPoint> const& points) const
{
    int const k = basis_.count();
    std::array<cv::Mat, 3> out;
    for (cv::Mat& m : out) m = cv::Mat(int(points.size()), k, CV_32F, cv::Scalar(0));
    auto const from_points = look_around(points, 11);
    std::size_t all = 0;
    for (auto const& hits : from_points) all += hits.size();
    if (all == 0) return out;
    std::vector<ReceivingPoint> places;
    double const step = std::max(1.0, double(all) / double(kPlaces));
    double next = 0.5 * step;
    std::size_t n = 0;
    for (auto const& hits : from_points)
        for (FoundHit const& h : hits)
            if (double(n++) >= next) {
                places.push_back(h.point);
                next += step;
            }
    if (places.empty()) places.push_back(from_points[0].empty() ? points[0] : from_points[0][0].point);
    auto const met_by_points = by_places(from_points, places);
    auto const met_by_places = by_places(look_around(places, 12), places);
    cv::Mat const first = direct(places);
    // Irradiance of the places per unit radiance: direct + reflected by what they see, bounce after bounce.
    auto const gathered = [&](std::vector<MetPlace> const& met, cv::Mat const& of_places, int channel, float* to) {
        std::fill(to, to + k, 0.0f);
        for (MetPlace const& m : met) {
            float const share = m.albedo[channel] / kAround;
            float const* const from = of_places.ptr<float>(m.place);
            for (int j = 0; j < k; ++j) to[j] += share * from[j];
        }
    };
    for (int c = 0; c < 3; ++c) {
        cv::Mat light = first.clone();
        for (int bounce = 0; bounce < kBounces; ++bounce) {
            cv::Mat after(first.size(), CV_32F);
            tbb::parallel_for(0, first.rows, [&](int i) {
                gathered(met_by_places[std::size_t(i)], light, c, after.ptr<float>(i));
                for (int j = 0; j < k; ++j) after.ptr<float>(i)[j] += first.ptr<float>(i)[j];
            });
            light = after;
        }
        tbb::parallel_for(std::size_t(0), points.size(), [&](std::size_t i) {
            gathered(met_by_points[i], light, c, out[std::size_t(c)].ptr<float>(int(i)));
        });
    }
    return out;
}

} // namespace ar
