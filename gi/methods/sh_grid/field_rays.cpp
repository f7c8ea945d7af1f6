#include "gi/methods/sh_grid/field_rays.h"

#include "gi/core/rng.h"
#include "gi/methods/sh_grid/met_surface.h"
#include "gi/render/flush_denormals.h"
#include "gi/render/path_step.h"

#include <algorithm>
#include <bit>
#include <optional>
#include <tbb/parallel_for.h>

namespace gi {
namespace {

constexpr int kMostMirrors = 8; ///< smooth surfaces along one ray

FieldHit met_patch(std::span<FieldTarget const> levels, MetSurface const& at, std::uint32_t triangle)
{
    vec3 const n = glm::round(127.0f * at.geometric_normal);
    for (std::size_t level = 0; level < levels.size(); ++level) {
        std::uint32_t const patch = patch_at(levels[level].blocks, levels[level].patches, at.position, triangle);
        if (patch != kNoCell)
            return {2 * patch + (at.front ? 0u : 1u),
                    std::uint8_t(level),
                    {std::int8_t(n.x), std::int8_t(n.y), std::int8_t(n.z)},
                    0,
                    {}};
    }
    return {FieldHit::kNothing, 0, {}, 0, {}};
}

/// A ray from a cell on its way.
struct FieldRay {
    std::uint32_t direction; ///< index
    vec3 tint{1};            ///< of light along the way so far
    float bent_after = kInf; ///< m, see FieldHit::distance
    std::uint32_t medium = kNoMedium;
};

/// Continues a ray at a mirror or glass. Returns none if it ends there.
std::optional<Ray> follow(WorldView const& w, Hit const& hit, RayQuery const& query, vec3 start, FieldRay& ray)
{
    vec3 const direction = query.ray.direction;
    ShadingPoint const at = shading_point(w, hit.triangle, hit.barycentric, direction);
    Pcg32 rng = Pcg32::for_path(0x3f1e, query.seed, std::bit_cast<std::uint32_t>(direction.x));
    BsdfSample const next = sample(at.bsdf, at.frame.to_local(-direction), at.front, rng.uniform(), vec2{0.5f});
    ray.tint *= next.weight * left_by_medium(w, ray.medium, hit.triangle, at, hit.distance);
    ray.medium = medium_beyond(w, ray.medium, hit.triangle, at, next);
    // Over the square of the index: the same inside of glass as before it. Cells there serve surfaces outside.
    if (next.transmitted && !at.bsdf.thin) ray.tint *= square(at.front ? at.bsdf.ior : 1 / at.bsdf.ior);
    bool const straight = next.transmitted && at.bsdf.thin;
    if (!straight) ray.bent_after = std::min(ray.bent_after, glm::dot(at.position - start, direction));
    vec3 const leaves = straight ? direction : at.frame.to_world(next.wi);
    if (!(max_component(ray.tint) > 0) || !is_on_one_side(at, leaves, next.wi)) return {};
    return Ray{leave(at, leaves), leaves};
}

} // namespace

void trace_field_rays(World const& world, ExactVisibility const& visibility, std::span<FieldTarget const> levels,
                      GridFrame const& frame, std::span<FieldDirection const> directions,
                      std::span<std::uint32_t const> cells, std::span<FieldHit> hits)
{
    WorldView const w = view(world);
    std::size_t const n = directions.size();
    tbb::parallel_for(std::size_t(0), cells.size(), [&](std::size_t i) {
        FlushDenormals const guard;
        vec3 const center = frame.center(frame.cell_of(cells[i]));
        std::vector<RayQuery> queries(n);
        std::vector<FieldRay> rays(n);
        for (std::uint32_t k = 0; k < n; ++k) {
            queries[k] = {.ray = {center, directions[k].direction}, .seed = std::uint32_t(cells[i] * n + k)};
            rays[k].direction = k;
        }
        std::vector<Hit> found(n);
        for (int mirrors = 0; !queries.empty(); ++mirrors) {
            visibility.nearest(queries, {found.data(), queries.size()});
            std::size_t left = 0;
            for (std::size_t k = 0; k < queries.size(); ++k) {
                FieldRay ray = rays[k];
                FieldHit& out = hits[i * n + ray.direction];
                out = {FieldHit::kSky, 0, {}, ray.bent_after, {}};
                if (found[k].triangle == kNoTriangle) continue;
                vec3 const direction = queries[k].ray.direction;
                MetSurface const at = met_surface(w, found[k].triangle, found[k].barycentric, direction);
                if (at.smooth) {
                    auto const next = mirrors < kMostMirrors ? follow(w, found[k], queries[k], center, ray)
                                                             : std::optional<Ray>();
                    if (next) {
                        queries[left] = {.ray = *next, .seed = queries[k].seed};
                        rays[left++] = ray;
                        continue;
                    }
                    out.what = FieldHit::kNothing;
                } else {
                    out = met_patch(levels, at, found[k].triangle);
                    if (mirrors > 0) out.tint = packed(ray.tint);
                }
                out.distance = ray.bent_after < kInf ? ray.bent_after : glm::dot(at.position - center, direction);
            }
            queries.resize(left);
        }
    });
}

} // namespace gi
