#include "gi/methods/sh_grid/field_light.h"

#include "gi/hit_buffers/directions/direction_map.h"
#include "gi/methods/whitted/caustic_light.h"
#include "gi/methods/whitted/lobe_light.h"
#include "gi/scene/shading/warp.h"

#include <algorithm>

namespace gi {
namespace {

template <class T>
T series(T const* coefficients, float const* y, int n)
{
    T sum{0};
    for (int k = 0; k < n; ++k) sum += y[k] * coefficients[k];
    return sum;
}

/// Mean distance and mean square in a direction, in cells: bilinear in the octahedral map, which goes on over its
/// sides turned by half a turn.
vec2 near_surfaces(FieldCell const& cell, vec3 direction)
{
    constexpr int n = FieldCell::kNear;
    vec2 const at = octahedral_from_direction(direction) * float(n) - 0.5f, low = glm::floor(at), part = at - low;
    vec2 sum{0};
    for (int k = 0; k < 4; ++k) {
        int x = int(low.x) + k % 2, y = int(low.y) + k / 2;
        if (x < 0 || x >= n) {
            x = glm::clamp(x, 0, n - 1);
            y = n - 1 - y;
        }
        if (y < 0 || y >= n) {
            y = glm::clamp(y, 0, n - 1);
            x = n - 1 - x;
        }
        float const weight = (k % 2 == 0 ? 1 - part.x : part.x) * (k / 2 == 0 ? 1 - part.y : part.y);
        sum += weight * cell.near[y * n + x];
    }
    return sum;
}

/// Upper bound of the probability that nothing is between a cell's centre and a point.
/// @param from_center  in cells
float visibility(FieldCell const& cell, vec3 from_center)
{
    float const distance = glm::length(from_center);
    if (!(distance > 0)) return 1;
    vec2 const near = near_surfaces(cell, from_center / distance);
    if (distance <= near.x) return 1;
    float const variance = std::max(near.y - square(near.x), 0.002f);
    float const bound = variance / (variance + square(distance - near.x));
    return std::max(bound * bound * bound, 1e-6f);
}

} // namespace

vec3 field_radiance(FieldCell const& cell, int degree, vec3 direction)
{
    float y[FieldCell::kMost];
    spherical_harmonics(direction, degree, y);
    return glm::max(series(cell.radiance, y, (degree + 1) * (degree + 1)), vec3{0});
}

vec3 field_irradiance(FieldCell const& cell, int degree, vec3 normal)
{
    // Ramamoorthi and Hanrahan 2001, eq. 7 and 8.
    constexpr float kCosine[kMostHarmonicsDegree + 1] = {kPi, 2 * kPi / 3, kPi / 4, 0, -kPi / 24};
    float y[FieldCell::kMost];
    spherical_harmonics(normal, degree, y);
    vec3 sum{0};
    for (int l = 0; l <= degree; ++l)
        for (int k = l * l; k < (l + 1) * (l + 1); ++k) sum += kCosine[l] * y[k] * cell.radiance[k];
    return glm::max(sum, vec3{0});
}

FieldLight::FieldLight(std::span<GridLevel const> levels, PhotonMap const* caustics,
                       ExactVisibility const& visibility, ShGridSettings const& settings)
    : caustics_(caustics),
      visibility_(visibility),
      degree_(levels.empty() ? 0 : levels[0].field.degree),
      coefficients_((degree_ + 1) * (degree_ + 1)),
      settings_(settings)
{
    for (GridLevel const& level : levels) levels_.push_back(level.field.cells.view());
}

void FieldLight::add_cells(std::size_t level, vec3 position, vec3 normal, float share,
                           std::vector<NearCell>& out) const
{
    constexpr float kReach = 1.75f; // r_max, cells
    constexpr float kAbove = 0.15f; // from where visibility is judged, cells above the surface
    CellsView<FieldCell> const& cells = levels_[level];
    vec3 const at = (position - cells.frame.low) / cells.frame.cell;
    glm::ivec3 const middle = cells.frame.at(position);
    std::size_t const first = out.size();
    float sum = 0;
    for (int k = 0; k < 27; ++k) {
        glm::ivec3 const c = middle + glm::ivec3{k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1};
        FieldCell const* const cell = cells.find(c);
        if (cell == nullptr) continue;
        vec3 const to_center = vec3(c) + 0.5f - at;
        float const d = glm::length(to_center) / kReach;
        if (d >= 1) continue;
        float weight = (2 * d - 3) * square(d) + 1; // w_sh
        if (settings_.leak_weights == Switch::on) {
            weight *= glm::clamp(2 * glm::dot(to_center, normal) + 0.1f, 1e-4f, 1.0f);
            weight *= std::max(square(cell->open), 1e-4f) * visibility(*cell, kAbove * normal - to_center);
        }
        sum += weight;
        out.push_back({cell, cells.frame.center(c), weight, cells.frame.cell});
    }
    for (std::size_t k = first; k < out.size(); ++k) out[k].weight *= sum > 0 ? share / sum : 0;
}

void FieldLight::find_cells(vec3 position, vec3 normal, std::vector<NearCell>& out) const
{
    out.clear();
    float left = 1;
    for (std::size_t level = 0; level < levels_.size(); ++level) {
        GridFrame const& frame = levels_[level].frame;
        vec3 const end = vec3(frame.size), at = (position - frame.low) / frame.cell;
        // Towards the sides of the fine grid, the coarse one takes over.
        float const inside = min_component(glm::min(at, end - at)) - 0.5f; // cells
        float const share = level + 1 == levels_.size() ? left : left * glm::clamp(inside, 0.0f, 1.0f);
        std::size_t const before = out.size();
        if (share > 0) add_cells(level, position, normal, share, out);
        if (out.size() > before) left -= share;
    }
    float sum = 0;
    for (NearCell const& near : out) sum += near.weight;
    for (NearCell& near : out) near.weight = sum > 0 ? near.weight / sum : 1 / float(out.size());
}

vec3 FieldLight::reflect(TreePoint& point, FieldCell const& cell) const
{
    ShadingPoint const& at = point.at;
    vec3 out{0};
    if (vec3 const response = diffuse_response(point); max_component(response) > 0) {
        vec3 arriving{0};
        if (settings_.gather_directions == 0) {
            arriving = field_irradiance(cell, degree_, at.frame.normal);
        } else {
            for (int k = 0; k < settings_.gather_directions; ++k) {
                vec2 const u{(float(k) + point.rng.uniform()) / float(settings_.gather_directions),
                             point.rng.uniform()};
                arriving += field_radiance(cell, degree_, at.frame.to_world(square_to_cosine_hemisphere(u)));
            }
            arriving *= kPi / float(settings_.gather_directions);
        }
        if (settings_.obscurance_m > 0) {
            float y[FieldCell::kMost];
            spherical_harmonics(at.frame.normal, degree_, y);
            arriving *= glm::clamp(series(cell.distance, y, coefficients_) / settings_.obscurance_m, 0.0f, 1.0f);
        }
        out += response * arriving;
    }
    int const n = point.direct ? settings_.glossy_directions : std::max(1, settings_.glossy_directions / 8);
    return out + glossy_radiance(point, n, [&](vec3 wi) { return field_radiance(cell, degree_, wi); });
}

void FieldLight::indirect(std::span<TreePoint> points, std::span<vec3> out, PathCounts& counts) const
{
    if (caustics_ != nullptr) add_caustics(*caustics_, points);
    if (levels_.empty()) {
        std::ranges::fill(out, vec3{0});
        return;
    }
    std::vector<NearCell> cells;
    std::vector<FieldCell> around(points.size());
    std::vector<ShadowRay> rays;
    std::vector<std::uint8_t> seen(points.size());
    auto const shadow_ray = [&](std::uint32_t i, NearCell const& near, float weight) {
        TreePoint& p = points[i];
        vec3 const from = leave(p.at, p.at.geometric_normal), way = near.center - from;
        float const length = glm::length(way);
        if (!(length > 0)) return;
        rays.push_back({{.ray = {from, way / length}, .reach = length, .seed = p.rng.next()}, near, weight, i});
    };
    for (std::uint32_t i = 0; i < points.size(); ++i) {
        TreePoint& p = points[i];
        if (!(p.wo.z > 0)) continue;
        find_cells(p.at.position, p.at.geometric_normal, cells);
        int const chosen = p.direct ? settings_.field_shadow_rays : std::min(settings_.field_shadow_rays, 1);
        if (chosen == 0) {
            for (NearCell const& near : cells) add(near, near.weight, around[i]);
            seen[i] = cells.empty() ? 0 : 1;
            continue;
        }
        float sum = 0, next = p.rng.uniform() / float(chosen);
        for (NearCell const& near : cells) {
            sum += near.weight;
            for (; sum > next; next += 1 / float(chosen)) shadow_ray(i, near, 1);
        }
    }
    add_visible(rays, around, counts, seen);
    rays.clear();
    for (std::uint32_t i = 0; i < points.size(); ++i) { // where none of these was seen: all cells
        if (seen[i] != 0 || !(points[i].wo.z > 0)) continue;
        find_cells(points[i].at.position, points[i].at.geometric_normal, cells);
        for (NearCell const& near : cells) shadow_ray(i, near, near.weight);
    }
    add_visible(rays, around, counts, seen);
    std::uint64_t none = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        out[i] = points[i].wo.z > 0 ? reflect(points[i], around[i]) : vec3{0};
        none += points[i].wo.z > 0 && seen[i] == 0 ? 1 : 0;
    }
    unseen_.fetch_add(none, std::memory_order_relaxed);
}

namespace {

constexpr float kGlyphRadius = 0.12f; ///< cells

/// Distance to where a ray enters a sphere, in units of the ray's direction, or a negative value.
float enter_sphere(vec3 origin, vec3 direction, vec3 center, float radius)
{
    vec3 const to_center = center - origin;
    float const along = glm::dot(to_center, direction);
    float const beside = glm::dot(to_center, to_center) - square(along);
    return beside < square(radius) ? along - std::sqrt(square(radius) - beside) : -1.0f;
}

/// The first of the spheres at the centres of cells along a ray: each point of a sphere shows the radiance that
/// arrives at the centre from the direction of the sphere's normal there (Chang, Park and Ihm, fig. 7).
/// @param reach  m; farther ones are ignored
std::optional<Glyph> nearest_glyph(CellsView<FieldCell> const& cells, int degree, Ray const& ray, float reach)
{
    constexpr float kStep = 1e-4f; // past borders, cells
    GridFrame const& frame = cells.frame;
    GridRay const in((ray.origin - frame.low) / frame.cell, ray.direction, vec3(frame.size), 0);
    float const stop = std::min(in.length, reach / frame.cell - in.skipped);
    for (float t = kStep; t < stop;) {
        glm::ivec3 const c{glm::floor(in.from + t * ray.direction)};
        if (FieldCell const* const cell = cells.find(c)) {
            vec3 const center = vec3(c) + 0.5f;
            float const at = enter_sphere(in.from, ray.direction, center, kGlyphRadius);
            if (at > 0 && at < stop) {
                vec3 const normal = (in.from + at * ray.direction - center) / kGlyphRadius;
                return Glyph{(in.skipped + at) * frame.cell, normal, field_radiance(*cell, degree, normal)};
            }
        }
        t = std::max(in.leaves(vec3(c), 1), t) + kStep;
    }
    return std::nullopt;
}

} // namespace

std::optional<Glyph> FieldLight::glyph(Ray const& ray, float reach) const
{
    return settings_.field_glyphs == Switch::on && !levels_.empty()
               ? nearest_glyph(levels_[0], degree_, ray, reach)
               : std::nullopt;
}

void FieldLight::add(NearCell const& near, float weight, FieldCell& out) const
{
    for (int c = 0; c < coefficients_; ++c) {
        out.radiance[c] += weight * near.cell->radiance[c];
        out.distance[c] += weight * near.cell_m * near.cell->distance[c];
    }
}

void FieldLight::add_visible(std::span<ShadowRay const> rays, std::span<FieldCell> out, PathCounts& counts,
                             std::span<std::uint8_t> seen) const
{
    std::vector<RayQuery> queries;
    for (ShadowRay const& r : rays) queries.push_back(r.query);
    std::vector<std::uint8_t> blocked(queries.size());
    visibility_.occluded(queries, blocked);
    counts.shadow_rays += queries.size();
    for (std::size_t k = 0; k < rays.size();) {
        std::uint32_t const i = rays[k].point;
        std::size_t end = k;
        float open = 0;
        for (; end < rays.size() && rays[end].point == i; ++end) open += blocked[end] == 0 ? rays[end].weight : 0;
        if (open > 0) seen[i] = 1;
        for (; k < end; ++k)
            if (blocked[k] == 0 && open > 0) add(rays[k].near, rays[k].weight / open, out[i]);
    }
}

} // namespace gi
