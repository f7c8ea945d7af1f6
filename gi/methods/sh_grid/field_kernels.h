#pragma once
// Steps of computing cells of the field, as kernels for CPU and CUDA.

#include "gi/methods/sh_grid/field.h"

namespace gi {

/// Radiance of the grid of one level, and of its coarser forms.
struct RadianceLevels {
    static constexpr std::size_t kMost = 10;
    CellsView<CellLight> level[kMost];
    View<std::uint32_t const> cells; ///< of level[0]: its cells
    View<PatchLight const> patches;
    View<std::uint32_t const> cell_of_patch; ///< index of its value
    std::size_t count = 0;
};

/// Light that leaves the surfaces of a cell towards a point, interpolated between the two levels whose faces'
/// areas are next to `area`. @param towards  see the other seen_light()  @param area  that the ray stands for, m^2
GI_FN inline SeenLight seen_light(RadianceLevels const& levels, FieldHit const& hit, vec3 towards,
                                  FieldSettings const& settings, float area)
{
    float const level = 0.5f * std::log2(glm::max(area / square(levels.level[0].frame.cell), 1.0f));
    std::size_t const last = levels.count - 1;
    std::uint32_t const place = settings.patches ? levels.cell_of_patch[hit.what / 2] : hit.what;
    glm::ivec3 const cell = levels.level[0].frame.cell_of(levels.cells[place]);
    bool const by_patch = settings.patches && settings.by == RadianceBy::normal;
    auto const of_level = [&](std::size_t k) {
        if (k == 0 && by_patch) return levels.patches[hit.what / 2].seen(hit.what & 1);
        CellLight const* const found = levels.level[k].find({cell.x >> k, cell.y >> k, cell.z >> k});
        return found != nullptr ? seen_light(*found, towards, settings.by) : SeenLight{};
    };
    std::size_t const fine = std::size_t(level) < last ? std::size_t(level) : last;
    SeenLight a = of_level(fine);
    float const part = level - float(fine);
    if (part <= 0 || fine == last || !(a.area > 0)) return a;
    SeenLight const b = of_level(fine + 1);
    if (b.area > 0) a.radiance = glm::mix(a.radiance, b.radiance, glm::min(part, 1.0f));
    return a;
}

/// Finds the hits of rays by a walk through the voxels. Normals are unknown: surfaces count as facing the ray.
struct WalkVoxels {
    CellsView<BlockVoxels> blocks;
    View<FieldDirection const> directions;
    std::uint32_t level;
    View<std::uint32_t const> cells; ///< of the rays' starts
    View<FieldHit> hits;             ///< per cell, by direction

    GI_FN void operator()(std::size_t i) const
    {
        vec3 const center = blocks.frame.center(blocks.frame.cell_of(cells[i]));
        for (std::size_t k = 0; k < directions.size(); ++k) {
            // The eight voxels about the centre are passed.
            float const start = 0.2501f * blocks.frame.cell / max_component(glm::abs(directions[k].direction));
            GridHit const hit = walk_grid(blocks, center, directions[k].direction, start);
            vec3 const back = -127.0f * directions[k].direction;
            FieldHit out{FieldHit::kSky, std::uint8_t(level), {}, kInf, {}};
            for (int axis = 0; axis < 3; ++axis) out.towards[axis] = std::int8_t(back[axis]);
            if (hit.distance >= 0) {
                out.what = blocks.find_place(hit.block);
                out.distance = hit.distance;
            }
            hits[i * directions.size() + k] = out;
        }
    }
};

/// Projects the light found by the rays of cells on spherical harmonics.
struct ProjectLight {
    RadianceLevels light[2]; ///< by level
    View<FieldDirection const> directions;
    View<FieldDirections::Weight const> weights;
    View<std::uint32_t const> firsts;
    FieldSettings settings;
    float cell_m;
    float share;                     ///< of the new values, the rest is of the former ones
    View<FieldHit const> hits;       ///< of these cells, by direction
    View<std::uint32_t const> which; ///< indices of the cells' values
    View<FieldCell> field;

    GI_FN void operator()(std::size_t i) const
    {
        std::size_t const n = directions.size(),
                          coefficients = std::size_t((settings.degree + 1) * (settings.degree + 1));
        FieldHit const* const met = &hits[i * n];
        FieldCell cell;
        float const weight = 4 * kPi / float(n);
        std::size_t closed = 0;
        for (std::size_t k = 0; k < n; ++k) {
            FieldDirection const& d = directions[k];
            FieldHit const hit = met[k];
            SeenLight seen;
            if (hit.what < FieldHit::kNothing) {
                float const area = settings.multilevel ? weight * square(hit.distance) : 0;
                vec3 const towards =
                    vec3{float(hit.towards[0]), float(hit.towards[1]), float(hit.towards[2])} / 127.0f;
                seen = seen_light(light[hit.level], hit,
                                  settings.by == RadianceBy::normal ? towards : -d.direction, settings, area);
                seen.radiance *= hit.tint.unpacked();
            }
            if (!(seen.area > 0) && !(hit.what == FieldHit::kSky && settings.sky_shines)) ++closed;
            float const distance = glm::min(hit.distance / cell_m, settings.farthest);
            for (std::size_t c = 0; c < coefficients; ++c) {
                float const y = weight * d.harmonics[c];
                cell.radiance[c] += y * seen.radiance;
                cell.distance[c] += y * distance;
            }
        }
        for (std::size_t texel = 0; texel + 1 < firsts.size(); ++texel)
            for (std::uint32_t k = firsts[texel]; k < firsts[texel + 1]; ++k) {
                float const distance =
                    glm::min(met[weights[k].direction].distance / cell_m, FieldCell::kNearReach);
                cell.near[texel] += weights[k].weight * vec2{distance, square(distance)};
            }
        cell.open = 1 - float(closed) / float(n);
        FieldCell& out = field[which[i]];
        for (std::size_t c = 0; c < coefficients; ++c) {
            out.radiance[c] += share * (cell.radiance[c] - out.radiance[c]);
            out.distance[c] += share * (cell.distance[c] - out.distance[c]);
        }
        for (int texel = 0; texel < FieldCell::kNear * FieldCell::kNear; ++texel)
            out.near[texel] += share * (cell.near[texel] - out.near[texel]);
        out.open += share * (cell.open - out.open);
    }
};

} // namespace gi
