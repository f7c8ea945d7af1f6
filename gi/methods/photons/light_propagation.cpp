#include "gi/methods/photons/light_propagation.h"

#include "gi/core/error.h"
#include "gi/kernel/stoppable_launch.h"
#include "gi/methods/photons/lattice_kernels.h"
#include "gi/methods/photons/propagation_kernels.h"
#include "gi/methods/sh_grid/voxels.h"

#include <algorithm>
#include <fmt/format.h>

namespace gi {
namespace {

constexpr float kRadianceOfDegree0 = kNearSolidAngle / kPi, kRadianceOfDegree1 = kNearAlong / (2 * kPi / 3);

/// Radiance by the direction from which light comes, of a cell's intensity by that in which it travels.
ShColor arriving_radiance(ShColor of, float cell_m)
{
    float const by = 1 / square(cell_m);
    of.c[0] *= by * kRadianceOfDegree0;
    for (int k = 1; k < 4; ++k) of.c[k] *= -by * kRadianceOfDegree1;
    return of;
}

/// Adds projected areas of triangles, by the cells of the corners. A voxel of the voxeliser is such a cell.
void add_blockers(World const& world, BuildStop const& stop, LightPropagation::Cascade& cascade)
{
    constexpr std::size_t kTogether = std::size_t(1)
                                      << 18; // of triangles, which bounds the memory of their pieces
    GridFrame blocks = cascade.corners;
    blocks.cell *= 4;
    blocks.size = (blocks.size + 3) / 4;
    float const of_face = 1 / square(cascade.frame.cell);
    for (std::size_t first = 0; first < world.triangles.size(); first += kTogether) {
        VoxelGrid grid{SparseCells<BlockVoxels>(blocks), {}};
        add_triangles(world, first, std::min(world.triangles.size(), first + kTogether), grid, stop);
        for (SurfacePiece const& p : grid.pieces) {
            glm::ivec3 const c = 4 * blocks.cell_of(grid.blocks.cells[p.block]) +
                                 glm::ivec3{p.voxel % 4, p.voxel / 4 % 4, p.voxel / 16};
            if (cascade.corners.holds(c))
                cascade.blocked[cascade.corners.index(c)] +=
                    {of_face * p.area * glm::abs(p.normal), of_face * p.area * glm::abs(p.normal) * p.point};
        }
    }
}

/// Mean of the eight cells around a point by trilinear weights, those behind surfaces without weight: seen from
/// the cell that holds the point, on the way along the axes. @param at  not in a surface
ShColor open_mean(LightPropagation::Cascade const& cascade, vec3 at)
{
    GridFrame const& frame = cascade.frame;
    vec3 const in = glm::clamp((at - frame.low) / frame.cell, -2.0f, 1e6f);
    glm::ivec3 const base = glm::ivec3(glm::floor(in));
    vec3 const part = in - vec3(base) - 0.5f;
    glm::ivec3 const way = glm::mix(glm::ivec3{-1}, glm::ivec3{1}, glm::greaterThanEqual(part, vec3{0}));
    vec3 beside = glm::abs(part);
    for (int axis = 0; axis < 3 && !cascade.open.empty(); ++axis) {
        glm::ivec3 face = base;
        face[axis] += way[axis] > 0 ? 1 : 0;
        if (cascade.corners.holds(face)) beside[axis] *= cascade.open[cascade.corners.index(face)][axis];
    }
    ShColor sum;
    float weights = 0;
    for (int k = 0; k < 8; ++k) {
        glm::ivec3 cell = base;
        float weight = 1;
        for (int axis = 0; axis < 3; ++axis) {
            bool const other = (k >> axis & 1) != 0;
            cell[axis] += other ? way[axis] : 0;
            weight *= other ? beside[axis] : 1 - std::abs(part[axis]);
        }
        weights += weight;
        if (frame.holds(cell)) sum += weight * cascade.total[frame.index(cell)];
    }
    return (1 / weights) * sum;
}

void check(PropagationSettings const& s)
{
    if (s.cells < 8 || s.cells > PropagationSettings::kMostCells || s.cascades < 0 ||
        s.cascades > PropagationSettings::kMostCascades || s.steps < 0)
        throw InputError(fmt::format("{} nested lattices of {} cells a side", s.cascades, s.cells),
                         fmt::format("0 (by what is shown) to {} of 8 to {} are supported",
                                     PropagationSettings::kMostCascades, PropagationSettings::kMostCells),
                         "choose others");
}

/// A point in front of a surface, beyond the cell faces blocked by this surface and others nearby.
/// In the lattice, surfaces lie at the nearest corners; points are kept on their side of these,
/// then moved by half a cell along the normal's largest component.
vec3 in_front(LightPropagation::Cascade const& cascade, vec3 position, vec3 normal)
{
    constexpr float kBlocks = 0.2f; // so much of a face
    float const cell = cascade.frame.cell, step = cell / std::max(max_component(glm::abs(normal)), 0.5f);
    vec3 at = position + 0.1f * step * normal;
    glm::ivec3 const corner = cascade.corners.at(at);
    if (!cascade.blocked.empty() && cascade.corners.holds(corner)) {
        Blocker const& near = cascade.blocked[cascade.corners.index(corner)];
        vec3 const center = cascade.corners.center(corner);
        for (int axis = 0; axis < 3; ++axis) {
            if (near.area[axis] < kBlocks) continue;
            bool const above = at[axis] * near.area[axis] >= near.moment[axis];
            at[axis] = above ? std::max(at[axis], center[axis] + 0.01f * cell)
                             : std::min(at[axis], center[axis] - 0.01f * cell);
        }
    }
    return at + 0.4f * step * normal;
}

} // namespace

std::vector<ReflectedLight> reflected_lights(std::span<Photon const> photons)
{
    std::vector<ReflectedLight> out;
    for (Photon const& p : photons) {
        vec3 const flux = p.flux * p.reflected;
        if (max_component(flux) > 0 && all_finite(flux)) out.push_back({p.position, p.normal, flux});
    }
    return out;
}

LightPropagation::LightPropagation(PropagationSettings const& settings) : settings_(settings) { check(settings); }

std::uint64_t LightPropagation::bytes(PropagationSettings const& s, Bounds const& bounds)
{
    if (bounds.empty()) return 0;
    // Light of two steps, their sum, factors of faces, what blocks and what is open at the corners.
    return dense_bytes(
        nested_frames(bounds, bounds.center(), s.cells, s.cascades > 0 ? s.cascades : s.kMostCascades),
        3 * sizeof(ShColor) + 2 * sizeof(vec3) + sizeof(Blocker));
}

void LightPropagation::place(std::span<GridFrame const> frames)
{
    cascades_.assign(frames.size(), {});
    for (std::size_t k = 0; k < frames.size(); ++k) {
        Cascade& cascade = cascades_[k];
        cascade.frame = cascade.corners = frames[k];
        cascade.corners.low -= 0.5f * frames[k].cell;
        cascade.corners.size += 1;
        cascade.total.resize(frames[k].cells());
    }
}

void LightPropagation::propagate(Cascade& cascade, Cascade const* coarser, std::span<ReflectedLight const> lights,
                                 BuildStop const& stop)
{
    GridFrame const& frame = cascade.frame;
    std::size_t const n = frame.cells();
    cascade.total.assign(n, {});
    cascade.injected_w = cascade.outside_w = 0;
    std::vector<std::uint64_t> keys(lights.size());
    for (std::size_t i = 0; i < lights.size(); ++i) {
        glm::ivec3 const cell = frame.at(in_front(cascade, lights[i].position, lights[i].normal));
        bool const in = frame.holds(cell);
        keys[i] = in ? frame.index(cell) : n;
        (in ? cascade.injected_w : cascade.outside_w) += double(glm::dot(lights[i].flux, vec3{1}));
    }
    ItemsByCell const sorted = sort_by_cell(keys, n);
    View<ReflectedLight const> const all{lights.data(), lights.size()};
    launch(Space::host, "inject virtual lights", n,
           SumItems<ReflectedLight, ShColor>{all, sorted.order, sorted.firsts, cascade.total});
    std::vector<ShColor> now = cascade.total, next(n);
    std::vector<vec3> scales(n);
    int const steps = settings_.steps > 0 ? settings_.steps : 2 * settings_.cells;
    for (int step = 0; step < steps; ++step) {
        launch_host(n, ScaleFaces{now, scales}, stop);
        DenseView<ShColor> const around = step == 0 && coarser != nullptr ? coarser->view() : DenseView<ShColor>{};
        launch_host(
            n,
            Propagate{
                {frame, now}, scales, cascade.corners, cascade.open, around, settings_.by, next, cascade.total},
            stop);
        std::swap(now, next);
    }
}

void LightPropagation::propagate(std::span<GridFrame const> frames, std::span<ReflectedLight const> lights)
{
    place(frames);
    for (std::size_t k = cascades_.size(); k-- > 0;)
        propagate(cascades_[k], k + 1 < cascades_.size() ? &cascades_[k + 1] : nullptr, lights,
                  BuildStop(nullptr));
}

void LightPropagation::update(World const& world, Geometry geometry, std::span<Photon const> photons, vec3 camera,
                              Bounds const& focus, BuildStop const& stop)
{
    if (world.bounds.empty()) return cascades_.clear();
    bool const by_focus = settings_.cascades == 0;
    std::vector<GridFrame> const frames = nested_frames(
        world.bounds, by_focus ? center_of(focus, camera) : camera, settings_.cells,
        by_focus ? nested_cascades(world.bounds, focus, PropagationSettings::kMostCascades) : settings_.cascades);
    std::vector<Cascade> former;
    std::swap(former, cascades_);
    place(frames);
    std::vector<ReflectedLight> const lights = reflected_lights(photons);
    try {
        for (std::size_t k = cascades_.size(); k-- > 0;) {
            Cascade& cascade = cascades_[k];
            if (geometry == Geometry::same && k < former.size() && same(former[k].frame, cascade.frame)) {
                cascade.open = former[k].open;
                cascade.blocked = former[k].blocked;
            } else {
                cascade.blocked.resize(cascade.corners.cells());
                cascade.open.resize(cascade.corners.cells());
                add_blockers(world, stop, cascade);
                launch(Space::host, "open faces of cells", cascade.corners.cells(),
                       OpenFaces{cascade.corners, cascade.blocked, cascade.open});
            }
            propagate(cascade, k + 1 < cascades_.size() ? &cascades_[k + 1] : nullptr, lights, stop);
        }
    } catch (Interrupted const&) {
        cascades_ = std::move(former);
        throw;
    }
}

vec3 LightPropagation::irradiance(vec3 position, vec3 normal) const
{
    vec3 sum{0};
    for_grids_at(cascades_, position, [&](std::size_t k, float weight) {
        GridFrame const& frame = cascades_[k].frame;
        vec3 const at = in_front(cascades_[k], position, normal);
        ShColor const light = arriving_radiance(open_mean(cascades_[k], at), frame.cell);
        sum += weight * glm::max(gi::irradiance(light, normal), vec3{0});
    });
    return sum;
}

vec3 LightPropagation::radiance(vec3 position, vec3 direction) const
{
    if (cascades_.empty()) return vec3{0};
    vec3 sum{0}, at = position;
    float weights = 0, open = 1;
    for (int step = 0; step < settings_.glossy_cells && open > 0.01f; ++step) {
        std::size_t finest = 0;
        while (finest + 1 < cascades_.size() && weight_in(cascades_[finest].frame, at) <= 0) ++finest;
        float const cell = cascades_[finest].frame.cell;
        at += (step == 0 ? 0.75f : 1.0f) * cell * direction;
        if (!cascades_[finest].frame.holds(cascades_[finest].frame.at(at))) break;
        if (step > 0 && !cascades_[finest].blocked.empty()) {
            DenseView<Blocker> const blocked{cascades_[finest].corners, cascades_[finest].blocked};
            vec3 const area = trilinear<Blocker>(blocked, at - 0.5f * cell * direction).area;
            open *= std::max(0.0f, 1 - glm::dot(area, glm::abs(direction)));
        }
        vec3 here{0};
        for_grids_at(cascades_, at, [&](std::size_t k, float weight) {
            ShColor const light = arriving_radiance(open_mean(cascades_[k], at), cascades_[k].frame.cell);
            here += weight * glm::max(evaluate(light, direction), vec3{0});
        });
        sum += open * here;
        weights += open;
    }
    return weights > 0 ? sum / weights : vec3{0};
}

} // namespace gi
