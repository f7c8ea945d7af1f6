#include "viewer/offline/first_view.h"

#include "gi/core/step.h"
#include "gi/render/exact_visibility.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace viewer {
namespace {

using gi::vec3;

constexpr int kGrid = 11;            // places along each side of the floor plan
constexpr int kMostFloors = 8;       // surfaces below one another
constexpr int kRays = 512;           // of a place, over the sphere
constexpr float kEyeHeight_m = 1.6f; // as of a standing user
constexpr float kInside = 0.9f;      // share of rays near the horizontal that meet something, seen from the front
constexpr float kEnough = 0.1f;      // share of all places that are inside: a box with an open side has fewer,
constexpr float kOpen = 0.25f;       // and from outside one sees so far into it, relative to its depth
constexpr int kDirections = 32;      // horizontal ones to look along

/// Points of a Fibonacci lattice on the sphere.
std::vector<vec3> sphere_directions()
{
    std::vector<vec3> all;
    for (int i = 0; i < kRays; ++i) {
        float const y = 1 - (2 * float(i) + 1) / float(kRays), r = std::sqrt(1 - y * y);
        float const turn = float(i) * 2.39996323f; // golden angle
        all.push_back({r * std::cos(turn), y, r * std::sin(turn)});
    }
    return all;
}

class Explorer {
public:
    /// @param part  of the world, where places are looked for
    Explorer(gi::World const& world, gi::Bounds const& part)
        : world_(world),
          rays_(world, false, 0, ~std::size_t(0), gi::stop_of_steps()),
          directions_(sphere_directions()),
          part_(part)
    {
        add_room();
        size_ = part_.high - part_.low;
        eye_m_ = std::clamp(kEyeHeight_m, 0.15f * size_.y, 0.6f * size_.y);
    }

    std::optional<gi::Camera> best(double fov_deg) const
    {
        float best_score = 0;
        vec3 best_place{0}, best_look{0};
        std::vector<vec3> const all = places();
        std::size_t inside = 0;
        for (vec3 const place : all) {
            gi::at_step("first camera");
            std::vector<gi::Hit> const hits = look_around(place);
            if (enclosure(hits) < kInside) continue;
            ++inside;
            auto const [look, seen] = best_direction(hits, fov_deg);
            // Far views in all directions, foremost in the one that is looked along.
            float const score = seen * (0.3f + openness(hits));
            if (score > best_score) {
                best_score = score;
                best_place = place;
                best_look = look;
            }
        }
        if (best_score == 0) return {};
        if (float(inside) < kEnough * float(all.size()) && depth_from_outside(fov_deg) > kOpen) return {};
        gi::dvec3 const from = world_.origin + gi::dvec3(best_place);
        return gi::look_at(from, from + gi::dvec3(best_look), fov_deg);
    }

private:
    /// The walls of a room have few triangles: what encloses the detailed part belongs to it.
    void add_room()
    {
        constexpr std::size_t kShare = 20; // one in this many hits on each side may be far off, behind a window
        vec3 const middle = part_.center(), half = 0.55f * (part_.high - part_.low);
        std::vector<vec3> met;
        for (int k = 0; k < 27; ++k) {
            vec3 const side{float(k % 3 - 1), float(k / 3 % 3 - 1), float(k / 9 - 1)};
            std::vector<gi::Hit> const hits = look_around(middle + side * half);
            if (enclosure(hits) < kInside) continue;
            for (std::size_t i = 0; i < hits.size(); ++i)
                if (hits[i].triangle != gi::kNoTriangle)
                    met.push_back(middle + side * half + hits[i].distance * directions_[i]);
        }
        if (met.empty()) return;
        for (int axis = 0; axis < 3; ++axis) {
            std::ranges::sort(met, {}, [axis](vec3 p) { return p[axis]; });
            part_.low[axis] = std::min(part_.low[axis], met[met.size() / kShare][axis]);
            part_.high[axis] = std::max(part_.high[axis], met[met.size() - 1 - met.size() / kShare][axis]);
        }
    }

    /// How far the rays of view_from_outside come into the detailed part,
    /// relative to their way through it: the median.
    float depth_from_outside(double fov_deg) const
    {
        constexpr int kSide = 32;
        gi::CameraRays const rays =
            gi::camera_rays(view_from_outside(world_, part_, fov_deg), kSide, kSide, world_.origin);
        std::vector<gi::RayQuery> queries;
        std::vector<glm::vec2> ways; // from where to where in the part
        for (int y = 0; y < kSide; ++y)
            for (int x = 0; x < kSide; ++x) {
                gi::Ray const ray = rays.through(gi::vec2(float(x) + 0.5f, float(y) + 0.5f));
                vec3 const a = (part_.low - ray.origin) / ray.direction,
                           b = (part_.high - ray.origin) / ray.direction;
                vec3 const near = glm::min(a, b), far = glm::max(a, b);
                float const in = std::max({near.x, near.y, near.z, 0.0f}), out = std::min({far.x, far.y, far.z});
                if (!(in < out)) continue;
                queries.push_back({ray});
                ways.emplace_back(in, out);
            }
        if (queries.empty()) return 0;
        std::vector<gi::Hit> hits(queries.size());
        rays_.nearest(queries, hits);
        std::vector<float> depths;
        for (std::size_t i = 0; i < hits.size(); ++i)
            depths.push_back(std::clamp((hits[i].distance - ways[i].x) / (ways[i].y - ways[i].x), 0.0f, 1.0f));
        std::ranges::nth_element(depths, depths.begin() + std::ptrdiff_t(depths.size() / 2));
        return depths[depths.size() / 2];
    }

    vec3 normal_of(gi::Hit const& h) const
    {
        gi::Surface const& s = world_.surfaces[h.triangle];
        return glm::normalize(glm::cross(s.edge1, s.edge2));
    }

    std::vector<vec3> places() const
    {
        std::vector<vec3> all;
        for (int z = 0; z < kGrid; ++z)
            for (int x = 0; x < kGrid; ++x) {
                vec3 from = part_.low + size_ * vec3((float(x) + 0.5f) / kGrid, 1.0f, (float(z) + 0.5f) / kGrid);
                from.y += 0.01f * size_.y;
                for (int floor = 0; floor < kMostFloors; ++floor) {
                    gi::RayQuery const down{{from, {0, -1, 0}}};
                    gi::Hit hit;
                    rays_.nearest({&down, 1}, {&hit, 1});
                    if (hit.triangle == gi::kNoTriangle) break;
                    from.y -= hit.distance;
                    if (normal_of(hit).y > 0.7f && has_room(from)) all.push_back(from + vec3(0, eye_m_, 0));
                    from.y -= 1e-4f * size_.y;
                }
            }
        return all;
    }

    /// The eyes and what is above them, and a body around them, do not stand in something.
    bool has_room(vec3 floor) const
    {
        std::vector<gi::RayQuery> queries{{{floor + vec3(0, 0.02f * eye_m_, 0), {0, 1, 0}}, 1.2f * eye_m_}};
        for (int k = 0; k < 8; ++k) {
            float const a = float(k) * 0.785398f;
            queries.push_back({{floor + vec3(0, eye_m_, 0), {std::cos(a), 0, std::sin(a)}}, 0.3f * eye_m_});
        }
        std::vector<std::uint8_t> blocked(queries.size());
        rays_.occluded(queries, blocked);
        return std::ranges::count(blocked, 1) == 0;
    }

    std::vector<gi::Hit> look_around(vec3 eye) const
    {
        std::vector<gi::RayQuery> queries;
        for (vec3 const d : directions_) queries.push_back({{eye, d}});
        std::vector<gi::Hit> hits(queries.size());
        rays_.nearest(queries, hits);
        return hits;
    }

    float enclosure(std::vector<gi::Hit> const& hits) const
    {
        int all = 0, met = 0;
        for (std::size_t i = 0; i < hits.size(); ++i) {
            if (std::abs(directions_[i].y) > 0.35f) continue;
            ++all;
            met += hits[i].triangle != gi::kNoTriangle && faces(hits[i], directions_[i]);
        }
        return float(met) / float(std::max(1, all));
    }

    /// The front of a surface, or one with two.
    bool faces(gi::Hit const& h, vec3 direction) const
    {
        return glm::dot(normal_of(h), direction) < 0 || is_two_sided(h);
    }
    bool is_two_sided(gi::Hit const& h) const
    {
        return world_.materials[world_.surfaces[h.triangle].material].double_sided;
    }

    float range() const { return 0.5f * std::max(size_.x, size_.z); }

    /// Mean distance over the horizontal half of the sphere, relative to the part's extent; at most 1.
    float openness(std::vector<gi::Hit> const& hits) const
    {
        float sum = 0;
        int n = 0;
        for (std::size_t i = 0; i < hits.size(); ++i) {
            if (std::abs(directions_[i].y) > 0.5f) continue;
            ++n;
            sum += std::min(1.0f, hits[i].distance / range());
        }
        return sum / float(std::max(1, n));
    }

    /// A horizontal direction and how much there is to see in it: mean distance, and how much it varies.
    std::pair<vec3, float> best_direction(std::vector<gi::Hit> const& hits, double fov_deg) const
    {
        float const cone = std::cos(float(glm::radians(0.6 * fov_deg)));
        std::pair<vec3, float> best{{0, 0, -1}, 0};
        for (int k = 0; k < kDirections; ++k) {
            float const a = 2 * gi::kPi * float(k) / kDirections;
            vec3 const look{std::sin(a), 0, -std::cos(a)};
            std::vector<float> seen;
            std::vector<std::uint32_t> materials;
            for (std::size_t i = 0; i < hits.size(); ++i) {
                if (glm::dot(directions_[i], look) < cone) continue;
                bool const met = hits[i].triangle != gi::kNoTriangle;
                seen.push_back(met ? std::min(1.0f, hits[i].distance / (2 * range())) : 0.0f);
                if (met) materials.push_back(world_.surfaces[hits[i].triangle].material);
            }
            if (seen.empty()) continue;
            float const mean = std::accumulate(seen.begin(), seen.end(), 0.0f) / float(seen.size());
            float variance = 0;
            for (float const s : seen) variance += (s - mean) * (s - mean) / float(seen.size());
            std::ranges::sort(materials);
            auto const kinds = float(std::ranges::unique(materials).begin() - materials.begin());
            float const score = (mean + std::sqrt(variance)) * std::sqrt(1 + kinds);
            if (score > best.second) best = {look, score};
        }
        return best;
    }

    gi::World const& world_;
    gi::ExactVisibility rays_;
    std::vector<vec3> directions_;
    gi::Bounds part_; ///< where places are looked for
    vec3 size_{0};    ///< of it
    float eye_m_ = 0;
};

} // namespace

gi::Bounds detailed_part(gi::World const& world)
{
    constexpr double kCut = 0.01, kWiden = 0.1;
    constexpr std::size_t kMost = 1 << 20; // corners looked at
    std::size_t const step = std::max<std::size_t>(1, 3 * world.triangles.size() / kMost);
    std::vector<vec3> corners;
    for (std::size_t c = 0; c < 3 * world.triangles.size(); c += step) {
        vec3 const p = world.positions[world.triangles[c / 3][int(c % 3)]];
        bool const inside = glm::all(glm::greaterThanEqual(p, world.bounds.low)) &&
                            glm::all(glm::lessThanEqual(p, world.bounds.high));
        if (inside) corners.push_back(p);
    }
    gi::Bounds part = world.bounds;
    if (corners.empty()) return part;
    auto const cut = std::size_t(kCut * double(corners.size()));
    for (int axis = 0; axis < 3; ++axis) {
        gi::at_step("first camera");
        auto const at = [&](std::size_t rank) {
            auto const nth = corners.begin() + std::ptrdiff_t(rank);
            std::ranges::nth_element(corners, nth, {}, [axis](vec3 p) { return p[axis]; });
            return (*nth)[axis];
        };
        float const low = at(cut), high = at(corners.size() - 1 - cut), more = float(kWiden) * (high - low);
        part.low[axis] = std::max(world.bounds.low[axis], low - more);
        part.high[axis] = std::min(world.bounds.high[axis], high + more);
    }
    return part;
}

std::optional<gi::Camera> view_from_inside(gi::World const& world, double fov_deg)
{
    if (world.triangles.empty() || world.bounds.empty()) return {};
    gi::Bounds const part = detailed_part(world);
    vec3 const size = part.high - part.low;
    if (!(std::min(size.x, std::min(size.y, size.z)) > 0)) return {}; // flat: nobody can be inside
    return Explorer(world, part).best(fov_deg);
}

gi::Camera view_from_outside(gi::World const& world, gi::Bounds const& bounds, double fov_deg)
{
    gi::dvec3 const center = gi::dvec3(bounds.empty() ? vec3{0} : bounds.center()) + world.origin;
    double const radius = bounds.empty() ? 1.0 : std::max(double(bounds.radius()), 1e-6);
    double const distance = 1.05 * radius / std::sin(0.5 * glm::radians(fov_deg));
    return gi::look_at(center + distance * glm::normalize(gi::dvec3{0.5, 0.35, 1}), center, fov_deg);
}

} // namespace viewer
