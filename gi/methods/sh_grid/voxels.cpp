#include "gi/methods/sh_grid/voxels.h"

#include "gi/core/error.h"
#include "gi/methods/sh_grid/settings.h"
#include "gi/scene/shading/shading_point.h"

#include <algorithm>
#include <array>
#include <bit>
#include <fmt/format.h>
#include <tbb/parallel_for.h>

namespace gi {
namespace {

/// Reach of a voxel beyond its sides, so that rounding misses none, voxels.
constexpr double kMargin = 1e-6;

/// A convex polygon: a triangle clipped by up to six planes. In voxels from the grid's corner.
struct VoxelPolygon {
    std::array<dvec3, 9> corner;
    int n = 0;
};

/// The part of a polygon on one side of an axis-aligned plane. @param sign  +1: above, -1: below
VoxelPolygon clip(VoxelPolygon const& p, int axis, double plane, double sign)
{
    VoxelPolygon out;
    for (int k = 0; k < p.n; ++k) {
        dvec3 const a = p.corner[std::size_t(k)], b = p.corner[std::size_t((k + 1) % p.n)];
        double const da = sign * (a[axis] - plane), db = sign * (b[axis] - plane);
        if (da >= 0 && out.n < 9) out.corner[std::size_t(out.n++)] = a;
        if (((da > 0 && db < 0) || (da < 0 && db > 0)) && out.n < 9) {
            dvec3 at = a + (da / (da - db)) * (b - a);
            at[axis] = plane;
            out.corner[std::size_t(out.n++)] = at;
        }
    }
    return out;
}

struct VoxelPiece {
    glm::ivec3 voxel;
    std::uint32_t triangle;
    dvec3 point, area; ///< voxels, voxels^2
};

/// Cuts a polygon into the voxels along `axis`, then along the next axes.
void cut(VoxelPolygon const& p, glm::ivec3 size, int axis, VoxelPiece& piece, std::vector<VoxelPiece>& out)
{
    if (p.n == 0) return;
    if (axis == 3) {
        dvec3 moment{0}, mean{0};
        double weights = 0;
        piece.area = dvec3{0};
        for (int k = 0; k < p.n; ++k) mean += p.corner[std::size_t(k)] / double(p.n);
        for (int k = 2; k < p.n; ++k) {
            dvec3 const a = p.corner[0], b = p.corner[std::size_t(k - 1)], c = p.corner[std::size_t(k)];
            dvec3 const area = 0.5 * glm::cross(b - a, c - a);
            piece.area += area;
            moment += glm::length(area) / 3 * (a + b + c);
            weights += glm::length(area);
        }
        piece.point = weights > 0 ? moment / weights : mean;
        // What lies in the margin belongs to the neighbour.
        dvec3 const in = piece.point - dvec3(piece.voxel);
        if (std::min({in.x, in.y, in.z}) < 0 || std::max({in.x, in.y, in.z}) >= 1) piece.area = dvec3{0};
        out.push_back(piece);
        return;
    }
    double low = 1e300, high = -1e300;
    for (int k = 0; k < p.n; ++k) {
        low = std::min(low, p.corner[std::size_t(k)][axis]);
        high = std::max(high, p.corner[std::size_t(k)][axis]);
    }
    double const end = double(size[axis]);
    if (high + kMargin < 0 || low - kMargin >= end) return;
    int const first = int(std::max(std::floor(low - kMargin), 0.0)),
              last = int(std::min(std::floor(high + kMargin), end - 1));
    for (int i = first; i <= last; ++i) {
        VoxelPolygon part = p;
        if (low < i - kMargin) part = clip(part, axis, i - kMargin, 1);
        if (high > i + 1 + kMargin) part = clip(part, axis, i + 1 + kMargin, -1);
        piece.voxel[axis] = i;
        cut(part, size, axis + 1, piece, out);
    }
}

/// True if the triangle scatters light otherwise than by mirroring and refracting it, at least in places.
bool scatters(WorldView const& w, std::uint32_t triangle, dvec3 area)
{
    double const length = glm::length(area);
    if (!(length > 0) || !std::isfinite(length)) return false;
    if (w.surfaces[triangle].is(Surface::kVaries)) return true;
    return !only_delta(shading_point(w, triangle, vec2{1.0f / 3}, vec3(area / -length)).bsdf);
}

} // namespace

std::uint64_t count_voxels(SparseCells<BlockVoxels> const& blocks)
{
    std::uint64_t sum = 0;
    for (BlockVoxels const v : blocks.values) sum += std::uint64_t(std::popcount(v));
    return sum;
}

VoxelGrid empty_voxel_grid(Bounds const& bounds, int voxels)
{
    if (voxels > ShGridSettings::kMostVoxels)
        throw InputError(fmt::format("a grid of {} voxels a side", voxels),
                         fmt::format("at most {} are supported: memory grows with the cube of their number",
                                     ShGridSettings::kMostVoxels),
                         "choose fewer");
    vec3 const extent = bounds.high - bounds.low;
    float const longest = std::max(max_component(extent), 1e-6f * (1 + max_component(glm::abs(bounds.center()))));
    GridFrame frame;
    float const voxel = longest / (float(voxels) - 1.25f);
    frame.cell = 4 * voxel;
    // Odd shares, so that walls of rooms do not lie on the borders of voxels.
    frame.low = bounds.low - voxel * vec3{0.57f, 0.61f, 0.53f};
    for (int axis = 0; axis < 3; ++axis)
        frame.size[axis] = std::max(1, (int(std::ceil(extent[axis] / voxel + 1.25f)) + 3) / 4);
    return {SparseCells<BlockVoxels>(frame), {}};
}

void add_triangles(World const& world, std::size_t first, std::size_t last, VoxelGrid& grid, BuildStop const& stop)
{
    constexpr std::size_t kChunk = 4096;
    GridFrame const& frame = grid.blocks.frame;
    float const voxel = grid.voxel_m();
    WorldView const w = view(world);
    std::size_t const chunks = (last - first + kChunk - 1) / kChunk;
    std::vector<std::vector<VoxelPiece>> parts(chunks);
    tbb::parallel_for(std::size_t(0), chunks, [&](std::size_t chunk) {
        if (stop.given_up()) throw Interrupted();
        std::size_t const begin = first + chunk * kChunk, end = std::min(last, begin + kChunk);
        for (std::size_t t = begin; t < end; ++t) {
            VoxelPolygon p;
            p.n = 3;
            bool usable = true;
            for (int k = 0; k < 3; ++k) {
                vec3 const corner = world.positions[world.triangles[t][k]];
                p.corner[std::size_t(k)] = (dvec3(corner) - dvec3(frame.low)) / double(voxel);
                usable = usable && all_finite(corner) && max_component(glm::abs(corner)) < kFarthest;
            }
            if (!usable ||
                !scatters(w, std::uint32_t(t), glm::cross(p.corner[1] - p.corner[0], p.corner[2] - p.corner[0])))
                continue;
            VoxelPiece piece{.voxel = {}, .triangle = std::uint32_t(t), .point = {}, .area = {}};
            cut(p, 4 * frame.size, 0, piece, parts[chunk]);
        }
    });
    for (auto const& part : parts)
        for (VoxelPiece const& p : part) {
            glm::ivec3 const in = p.voxel % 4;
            std::uint32_t const block = grid.blocks.place_at(p.voxel / 4);
            auto const voxel_of_block = std::uint8_t(in.x + 4 * in.y + 16 * in.z);
            grid.blocks.values[block] |= BlockVoxels(1) << voxel_of_block;
            double const size = glm::length(p.area);
            float const area = float(size * double(voxel) * double(voxel));
            if (!(area > 0)) continue;
            grid.pieces.push_back({.block = block,
                                   .triangle = p.triangle,
                                   .voxel = voxel_of_block,
                                   .point = vec3(dvec3(frame.low) + double(voxel) * p.point),
                                   .normal = vec3(p.area / size),
                                   .area = area});
        }
}

} // namespace gi
