#include "viewer/engine/live/walking.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace viewer {

Ground::Ground(gi::World const& world)
{
    still_.scene = std::make_shared<gi::Scene const>(); // no textures
    still_.origin = world.origin;
    still_.positions.assign(world.positions.begin(), world.positions.begin() + world.static_vertices);
    still_.triangles.assign(world.triangles.begin(), world.triangles.begin() + world.static_triangles);
    rays_ = std::make_unique<gi::ExactVisibility>(still_, false, 0);
}

std::optional<Ground::Touch> Ground::touch(gi::dvec3 from, gi::dvec3 direction, double reach_m) const
{
    gi::RayQuery const query{{gi::vec3(from - still_.origin), gi::vec3(direction)}, float(reach_m), 0};
    gi::Hit hit;
    rays_->nearest({&query, 1}, {&hit, 1});
    if (hit.triangle == gi::kNoTriangle) return std::nullopt;
    glm::uvec3 const v = still_.triangles[hit.triangle];
    gi::dvec3 const corner(still_.positions[v.x]);
    gi::dvec3 normal = glm::normalize(
        glm::cross(gi::dvec3(still_.positions[v.y]) - corner, gi::dvec3(still_.positions[v.z]) - corner));
    if (glm::dot(normal, direction) > 0) normal = -normal;
    return Touch{double(hit.distance), normal};
}

namespace {

using gi::dvec3;

constexpr double kStep_m = 0.1, kAbove_m = 0.02, kHeadroom_m = 0.1, kDeepest_m = 1e5;
constexpr dvec3 kDown{0, -1, 0}, kUp{0, 1, 0};

/// Heights at which the body collides with walls: above the highest climbable step, and at the eyes.
std::array<double, 3> heights(WalkStance const& s, WalkLimits const& limits)
{
    double const knee = std::min(limits.climb_m + kAbove_m, s.eye_m);
    return {knee, 0.5 * (knee + s.eye_m), s.eye_m};
}

/// Pushes the body away from walls nearer than its radius.
dvec3 pushed_out(Ground const& ground, dvec3 foot, WalkStance const& body, WalkLimits const& limits)
{
    constexpr int kAround = 8;
    for (int k = 0; k < kAround; ++k) {
        double const angle = 2 * double(gi::kPi) * k / kAround;
        dvec3 const way{std::cos(angle), 0, std::sin(angle)};
        for (double const h : heights(body, limits)) {
            auto const wall = ground.touch(foot + h * kUp, way, limits.radius_m);
            if (!wall) continue;
            dvec3 const level{wall->normal.x, 0, wall->normal.z};
            if (glm::length(level) < 0.1) continue; // a slope
            dvec3 const out = glm::normalize(level);
            foot += std::max(0.0, limits.radius_m + wall->distance_m * glm::dot(way, out)) * out;
        }
    }
    return foot;
}

bool is_free(Ground const& ground, dvec3 from, dvec3 to, WalkStance const& body, WalkLimits const& limits)
{
    double const far = glm::distance(from, to);
    if (far == 0) return true;
    for (double const h : heights(body, limits))
        if (ground.touch(from + h * kUp, (to - from) / far, far)) return false;
    return true;
}

} // namespace

std::optional<WalkStance> stand_below(Ground const& ground, dvec3 eyes, double eye_height_m)
{
    auto const floor = ground.touch(eyes, kDown, kDeepest_m);
    if (!floor) return std::nullopt;
    WalkStance s{eyes + floor->distance_m * kDown, eye_height_m};
    if (auto const ceiling = ground.touch(s.foot + 0.01 * kUp, kUp, eye_height_m + kHeadroom_m))
        s.eye_m = std::min(eye_height_m, std::max(0.5 * ceiling->distance_m, ceiling->distance_m - kHeadroom_m));
    return s;
}

WalkStance walk(Ground const& ground, WalkStance const& from, dvec3 way_m, WalkLimits const& limits)
{
    way_m.y = 0;
    double const far = glm::length(way_m);
    int const steps = int(std::ceil(far / kStep_m));
    WalkStance now = from;
    for (int i = 0; i < steps; ++i) {
        dvec3 next = pushed_out(ground, now.foot + way_m / double(steps), now, limits);
        if (!is_free(ground, now.foot, next, now, limits)) break;
        double const climb = std::min(limits.climb_m, now.eye_m);
        auto const floor = ground.touch(next + climb * kUp, kDown, climb + limits.drop_m);
        if (!floor) break;
        next += (climb - floor->distance_m) * kUp;
        // Start at the height of the floor search: a ray that starts on a surface may hit it.
        if (ground.touch(next + 0.01 * kUp, kUp, now.eye_m + 0.5 * kHeadroom_m)) break;
        now.foot = next;
    }
    return now;
}

} // namespace viewer
