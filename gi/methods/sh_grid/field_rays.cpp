#include "gi/methods/sh_grid/field_rays.h"

#include "gi/render/flush_denormals.h"
#include "gi/scene/shading/shading_point.h"

#include <algorithm>
#include <tbb/parallel_for.h>

namespace gi {
namespace {

constexpr int kMostPanes = 8; ///< smooth surfaces that one ray passes

FieldHit met_patch(std::span<FieldTarget const> levels, ShadingPoint const& at, std::uint32_t triangle,
                   float distance)
{
    vec3 const n = glm::round(127.0f * at.geometric_normal);
    for (std::size_t level = 0; level < levels.size(); ++level) {
        std::uint32_t const patch = patch_at(levels[level].blocks, levels[level].patches, at.position, triangle);
        if (patch != kNoCell)
            return {2 * patch + (at.front ? 0u : 1u),
                    std::uint8_t(level),
                    {std::int8_t(n.x), std::int8_t(n.y), std::int8_t(n.z)},
                    distance};
    }
    return {FieldHit::kNothing, 0, {}, distance};
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
        std::vector<std::uint32_t> ray_of(n);
        for (std::uint32_t k = 0; k < n; ++k) {
            queries[k] = {.ray = {center, directions[k].direction}, .seed = std::uint32_t(cells[i] * n + k)};
            ray_of[k] = k;
        }
        std::vector<Hit> found(n);
        for (int panes = 0; !queries.empty(); ++panes) {
            visibility.nearest(queries, {found.data(), queries.size()});
            std::size_t left = 0;
            for (std::size_t k = 0; k < queries.size(); ++k) {
                FieldHit& out = hits[i * n + ray_of[k]];
                out = {FieldHit::kSky, 0, {}, kInf};
                if (found[k].triangle == kNoTriangle) continue;
                vec3 const direction = queries[k].ray.direction;
                ShadingPoint const at = shading_point(w, found[k].triangle, found[k].barycentric, direction);
                float const distance = glm::dot(at.position - center, direction);
                if (!only_delta(at.bsdf)) {
                    out = met_patch(levels, at, found[k].triangle, distance);
                } else if (panes < kMostPanes && at.bsdf.clear > 0) {
                    queries[left] = {.ray = {leave(at, direction), direction}, .seed = queries[k].seed};
                    ray_of[left++] = ray_of[k];
                } else {
                    out = {FieldHit::kNothing, 0, {}, distance};
                }
            }
            queries.resize(left);
        }
    });
}

} // namespace gi
