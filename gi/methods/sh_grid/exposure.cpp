#include "gi/methods/sh_grid/exposure.h"

#include "gi/core/rng.h"
#include "gi/methods/sh_grid/met_surface.h"
#include "gi/scene/shading/warp.h"

#include <algorithm>
#include <tbb/parallel_for.h>

namespace gi {
namespace {

/// Few rays tell whether pieces are exposed. So of the area along an axis, less than kLeastExposed counts as none,
/// else as at least kSurelyExposed; and none counts that is less than kLeastOfCell of the cell's largest.
constexpr float kLeastExposed = 0.02f, kSurelyExposed = 0.2f, kLeastOfCell = 1e-3f;

/// See kLeastExposed. @param whole  area, exposed or not  @param largest  in the cell
float judged(float exposed, float whole, float largest)
{
    if (exposed < kLeastExposed * whole || whole < kLeastOfCell * largest) return 0;
    return std::max(exposed, kSurelyExposed * whole);
}

void add_piece(vec3 normal, float area, RadianceBy by, CellArea& out)
{
    if (by == RadianceBy::normal) return out.add(normal, area);
    // The mean of max(d . e, 0)^2 over the cosine lobe of directions d, for each axis e.
    for (int k = 0; k < 6; ++k)
        out.bin[k] += area * square(1 + (k % 2 == 0 ? -1.0f : 1.0f) * normal[k / 2]) * 0.125f;
}

} // namespace

void look_around(World const& world, ExactVisibility const& visibility, VoxelGrid const& grid, std::size_t first,
                 RayWorld met, BuildStop const& stop, Surroundings& out)
{
    constexpr std::size_t kTogether = 64, kRays = Surroundings::kRays, kOfSide = kRays + 1;
    GridFrame const& frame = grid.blocks.frame;
    WorldView const w = view(world);
    std::size_t const n = grid.pieces.size() - first;
    out.of_piece.resize(grid.pieces.size());
    tbb::parallel_for(std::size_t(0), (n + kTogether - 1) / kTogether, [&](std::size_t group) {
        if (stop.given_up()) throw Interrupted();
        std::size_t const begin = first + group * kTogether, end = std::min(grid.pieces.size(), begin + kTogether);
        std::vector<RayQuery> queries;
        for (std::size_t i = begin; i < end; ++i) {
            SurfacePiece const& piece = grid.pieces[i];
            vec3 const normal = piece.normal;
            float const clearance = 1e-4f * frame.cell + 1e-6f * max_component(glm::abs(piece.point));
            Pcg32 rng = Pcg32::for_path(0xe490, std::uint32_t(i), 0);
            for (int side = 0; side < 2; ++side) {
                Frame const about = Frame::about(side == 0 ? normal : -normal);
                vec3 const above = piece.point + clearance * about.normal;
                // Back to the piece itself, unless another one lies on it.
                queries.push_back({.ray = {above, -about.normal}, .reach = 2 * clearance, .seed = rng.next()});
                for (std::size_t k = 0; k < kRays; ++k)
                    queries.push_back({.ray = {above, about.to_world(square_to_cosine_hemisphere(rng.uniform2()))},
                                       .seed = rng.next()});
            }
        }
        std::vector<Hit> hits(queries.size());
        visibility.nearest(queries, hits, met);
        for (std::size_t k = 0; k < hits.size(); ++k) {
            std::size_t const ray = k % kOfSide, piece = begin + k / (2 * kOfSide);
            if (ray == 0) continue;
            std::uint32_t& code = out.of_piece[piece][k / kOfSide % 2][ray - 1];
            std::uint32_t const lies_there = hits[k - ray].triangle;
            if (lies_there != kNoTriangle && lies_there != grid.pieces[piece].triangle) {
                code = Surroundings::kNear;
                continue;
            }
            code = Surroundings::kSky;
            if (hits[k].triangle == kNoTriangle) continue;
            MetSurface const at = met_surface(w, hits[k].triangle, hits[k].barycentric, queries[k].ray.direction);
            glm::ivec3 const cell = frame.at(at.position);
            if (hits[k].distance < 0.02f * frame.cell)
                code = Surroundings::kNear;
            else if (at.smooth)
                code = Surroundings::kMirrorOrGlass;
            else if (frame.holds(cell))
                code = 16 * frame.index(cell) + ReachedSides::side_index(at.geometric_normal, at.front);
        }
    });
}

ExposedAreas exposed_areas(VoxelGrid const& grid, Patches const& patches, Surroundings const& surroundings,
                           ReachedSides const& reached, std::span<std::uint8_t const> lit, bool sky_shines,
                           RadianceBy by)
{
    ExposedAreas out;
    out.of_cell.resize(grid.blocks.values.size());
    out.of_patch.resize(patches.count());
    std::vector<CellArea> whole(out.of_cell.size());
    std::vector<float> whole_patch(patches.count());
    auto const lets_light_in = [&](std::uint32_t code) {
        if (code == Surroundings::kNear) return false;
        if (code == Surroundings::kSky) return sky_shines;
        return code == Surroundings::kMirrorOrGlass || (reached.of_cell[code / 16] >> code % 16 & 1) != 0;
    };
    auto const is_exposed = [&](std::size_t i, std::size_t side) {
        return std::ranges::any_of(surroundings.of_piece[i][side], lets_light_in);
    };
    for (std::size_t i = 0; i < grid.pieces.size(); ++i) {
        std::uint32_t const patch = patches.of_piece[i];
        whole_patch[patch] += grid.pieces[i].area;
        for (std::size_t side = 0; side < 2; ++side)
            if (is_exposed(i, side)) out.of_patch[patch][side] += grid.pieces[i].area;
    }
    for (std::size_t patch = 0; patch < whole_patch.size(); ++patch)
        for (std::size_t side = 0; side < 2; ++side) {
            float& exposed = out.of_patch[patch][side];
            exposed = judged(exposed, whole_patch[patch], 0);
            if (exposed == 0 && lit[2 * patch + side] != 0) exposed = whole_patch[patch]; // rays were wrong
        }
    for (std::size_t i = 0; i < grid.pieces.size(); ++i) {
        SurfacePiece const& piece = grid.pieces[i];
        std::uint32_t const patch = patches.of_piece[i];
        for (std::size_t side = 0; side < 2; ++side) {
            vec3 const normal = side == 0 ? piece.normal : -piece.normal;
            add_piece(normal, piece.area, by, whole[piece.block]);
            if (out.of_patch[patch][side] == whole_patch[patch] || is_exposed(i, side))
                add_piece(normal, piece.area, by, out.of_cell[piece.block]);
            else
                out.hidden_m2 += double(piece.area);
        }
    }
    for (std::size_t i = 0; i < whole.size(); ++i)
        for (int k = 0; k < 6; ++k) {
            float& exposed = out.of_cell[i].bin[k];
            exposed = judged(exposed, whole[i].bin[k], whole[i].largest());
        }
    return out;
}

} // namespace gi
