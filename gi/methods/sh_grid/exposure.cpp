#include "gi/methods/sh_grid/exposure.h"

#include "gi/core/rng.h"
#include "gi/methods/sh_grid/met_surface.h"
#include "gi/scene/shading/warp.h"

#include <algorithm>
#include <bit>
#include <numeric>
#include <optional>
#include <tbb/parallel_for.h>

namespace gi {
namespace {

/// Exposure is estimated by few rays. Of the area along an axis, less than kLeastExposed counts as 0,
/// more as at least kSurelyExposed; less than kLeastOfCell of the cell's largest counts as 0.
constexpr float kLeastExposed = 0.02f, kSurelyExposed = 0.2f, kLeastOfCell = 1e-3f;

/// See kLeastExposed. @param whole  area, exposed or not  @param largest  in the cell
float judged(float exposed, float whole, float largest)
{
    if (exposed < kLeastExposed * whole || whole < kLeastOfCell * largest) return 0;
    return std::max(exposed, kSurelyExposed * whole);
}

/// Rays overlook what is lit directly and sees only what is dark. Where photons show a larger share of a patch, by
/// this factor (voxels are coarse), they are right.
constexpr float kRaysWrong = 1.25f;

/// The voxels of a cell in which photons leave a patch's side.
BlockVoxels lit_voxels(SparseCells<BlockVoxels> const& blocks, Patches const& patches,
                       std::span<ReflectedPhoton const> photons, SortedPhotons const& sorted, std::size_t patch,
                       std::size_t side)
{
    GridFrame const& frame = blocks.frame;
    vec3 const low = vec3(frame.cell_of(blocks.cells[patches.cell_of_patch[patch]]));
    BlockVoxels lit = 0;
    for (std::uint32_t k = sorted.firsts[2 * patch + side]; k < sorted.firsts[2 * patch + side + 1]; ++k) {
        vec3 const in = (photons[sorted.order[k]].position - frame.low) / frame.cell - low;
        glm::ivec3 const v = glm::clamp(glm::ivec3(glm::floor(4.0f * in)), 0, 3);
        lit |= BlockVoxels(1) << (v.x + 4 * v.y + 16 * v.z);
    }
    return lit;
}

/// The share of a patch's voxels over which n photons must have been spread at random so that these are hit; none
/// if photons are too few to tell.
std::optional<float> lit_share(BlockVoxels of_patch, BlockVoxels lit, std::uint32_t n)
{
    float const all = float(std::max(std::popcount(of_patch), 1)), hit = float(std::popcount(lit));
    if (hit >= all) return 1.0f;
    auto const expected = [&](float voxels) { return voxels * (1 - std::exp(-float(n) / voxels)); };
    if (expected(all) <= hit) return std::nullopt;
    float low = hit, high = all;
    for (int k = 0; k < 12; ++k) {
        float const middle = 0.5f * (low + high);
        (expected(middle) < hit ? low : high) = middle;
    }
    return high / all;
}

void add_piece(vec3 normal, float area, RadianceBy by, CellArea& out)
{
    if (by == RadianceBy::normal) return out.add(normal, area);
    // The mean of max(d . e, 0)^2 over the cosine lobe of directions d, for each axis e.
    for (int k = 0; k < 6; ++k)
        out.bin[k] += area * square(1 + (k % 2 == 0 ? -1.0f : 1.0f) * normal[k / 2]) * 0.125f;
}

} // namespace

void choose_samples(std::span<SurfacePiece const> pieces, std::span<std::uint32_t const> patch_of,
                    std::vector<PatchSample>& out)
{
    constexpr std::size_t kMost = 16; // of a patch
    if (pieces.empty()) return;
    // Pieces by patch; the patches follow each other in numbers.
    auto const [low, high] = std::ranges::minmax(patch_of);
    std::vector<std::uint32_t> order(pieces.size()), place(high - low + 2);
    for (std::uint32_t const p : patch_of) ++place[p - low + 1];
    std::partial_sum(place.begin(), place.end(), place.begin());
    for (std::uint32_t i = 0; i < pieces.size(); ++i) order[place[patch_of[i] - low]++] = i;
    auto const add = [&](std::uint32_t i, float area) {
        SurfacePiece const& p = pieces[i];
        out.push_back({patch_of[i], p.triangle, p.point, p.normal, area, {}});
    };
    for (std::size_t first = 0, end = 0; first < order.size(); first = end) {
        float whole = 0;
        for (end = first; end < order.size() && patch_of[order[end]] == patch_of[order[first]]; ++end)
            whole += pieces[order[end]].area;
        if (end - first <= kMost) {
            for (std::size_t k = first; k < end; ++k) add(order[k], pieces[order[k]].area);
            continue;
        }
        float const part = whole / float(kMost);
        float sum = 0, next = 0.5f * part;
        std::size_t added = 0;
        for (std::size_t k = first; k < end && added < kMost; ++k) {
            sum += pieces[order[k]].area;
            for (; added < kMost && (sum > next || k + 1 == end); ++added, next += part) add(order[k], part);
        }
    }
}

void look_around(World const& world, ExactVisibility const& visibility, GridFrame const& frame, RayWorld met,
                 BuildStop const& stop, std::span<PatchSample> samples)
{
    constexpr std::size_t kTogether = 64, kOfSide = PatchSample::kRays + 1;
    WorldView const w = view(world);
    tbb::parallel_for(std::size_t(0), (samples.size() + kTogether - 1) / kTogether, [&](std::size_t group) {
        if (stop.given_up()) throw Interrupted();
        std::size_t const begin = group * kTogether, end = std::min(samples.size(), begin + kTogether);
        std::vector<RayQuery> queries;
        for (std::size_t i = begin; i < end; ++i) {
            PatchSample const& sample = samples[i];
            float const clearance = 1e-4f * frame.cell + 1e-6f * max_component(glm::abs(sample.point));
            Pcg32 rng = Pcg32::for_path(0xe490, std::uint32_t(i), 0);
            for (int side = 0; side < 2; ++side) {
                Frame const about = Frame::about(side == 0 ? sample.normal : -sample.normal);
                vec3 const above = sample.point + clearance * about.normal;
                // Back to the piece itself, unless another one lies on it.
                queries.push_back({.ray = {above, -about.normal}, .reach = 2 * clearance, .seed = rng.next()});
                for (std::size_t k = 0; k < PatchSample::kRays; ++k)
                    queries.push_back({.ray = {above, about.to_world(square_to_cosine_hemisphere(rng.uniform2()))},
                                       .seed = rng.next()});
            }
        }
        std::vector<Hit> hits(queries.size());
        visibility.nearest(queries, hits, met);
        for (std::size_t k = 0; k < hits.size(); ++k) {
            std::size_t const ray = k % kOfSide;
            if (ray == 0) continue;
            PatchSample& sample = samples[begin + k / (2 * kOfSide)];
            std::uint32_t& code = sample.met[k / kOfSide % 2][ray - 1];
            std::uint32_t const lies_there = hits[k - ray].triangle;
            if (lies_there != kNoTriangle && lies_there != sample.triangle) {
                code = PatchSample::kNear;
                continue;
            }
            code = PatchSample::kSky;
            if (hits[k].triangle == kNoTriangle) continue;
            MetSurface const at = met_surface(w, hits[k].triangle, hits[k].barycentric, queries[k].ray.direction);
            glm::ivec3 const cell = frame.at(at.position);
            if (hits[k].distance < 0.02f * frame.cell)
                code = PatchSample::kNear;
            else if (at.smooth)
                code = PatchSample::kMirrorOrGlass;
            else if (frame.holds(cell))
                code = 16 * frame.index(cell) + ReachedSides::side_index(at.geometric_normal, at.front);
        }
    });
}

ExposedAreas exposed_areas(SparseCells<BlockVoxels> const& blocks, Patches const& patches,
                           std::span<PatchSample const> samples, ReachedSides const& reached,
                           std::span<ReflectedPhoton const> photons, SortedPhotons const& sorted, bool sky_shines,
                           RadianceBy by)
{
    ExposedAreas out;
    std::size_t const cells = blocks.values.size();
    out.of_cell.resize(cells);
    out.of_patch.resize(patches.count());
    std::vector<CellArea> whole(cells);
    std::vector<float> whole_patch(patches.count());
    auto const lets_light_in = [&](std::uint32_t code) {
        if (code == PatchSample::kNear) return false;
        if (code == PatchSample::kSky) return sky_shines;
        return code == PatchSample::kMirrorOrGlass || (reached.of_cell[code / 16] >> code % 16 & 1) != 0;
    };
    for (PatchSample const& s : samples) {
        whole_patch[s.patch] += s.area;
        for (std::size_t side = 0; side < 2; ++side)
            if (std::ranges::any_of(s.met[side], lets_light_in)) out.of_patch[s.patch][side] += s.area;
    }
    tbb::parallel_for(std::size_t(0), whole_patch.size(), [&](std::size_t patch) {
        for (std::size_t side = 0; side < 2; ++side) {
            float& exposed = out.of_patch[patch][side];
            float const all = whole_patch[patch];
            exposed = judged(exposed, all, 0);
            if (!(exposed < all) || !sorted.hit(2 * patch + side)) continue;
            auto const share =
                lit_share(patches.voxels[patch], lit_voxels(blocks, patches, photons, sorted, patch, side),
                          sorted.count(2 * patch + side));
            if (!share && exposed == 0) exposed = all; // else the photons' light were lost
            if (share && all * *share > kRaysWrong * exposed) exposed = std::min(all * *share, all);
        }
    });
    for (PatchSample const& s : samples)
        for (std::size_t side = 0; side < 2; ++side) {
            vec3 const normal = side == 0 ? s.normal : -s.normal;
            std::uint32_t const cell = patches.cell_of_patch[s.patch];
            float const area = s.area * out.of_patch[s.patch][side] / whole_patch[s.patch];
            add_piece(normal, s.area, by, whole[cell]);
            add_piece(normal, area, by, out.of_cell[cell]);
            out.hidden_m2 += double(s.area - area);
        }
    for (std::size_t i = 0; i < whole.size(); ++i)
        for (int k = 0; k < 6; ++k) {
            float& exposed = out.of_cell[i].bin[k];
            exposed = judged(exposed, whole[i].bin[k], whole[i].largest());
        }
    return out;
}

} // namespace gi
