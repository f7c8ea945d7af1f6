#include "gi/methods/sh_grid/patches.h"

#include "gi/core/rqmc.h"

#include <algorithm>
#include <bit>
#include <numeric>
#include <tbb/parallel_for.h>

namespace gi {
namespace {

/// Sets that grow together.
struct JoinedSets {
    std::vector<std::uint32_t> parent;

    explicit JoinedSets(std::size_t n) : parent(n) { std::iota(parent.begin(), parent.end(), 0u); }
    std::uint32_t root(std::uint32_t k)
    {
        while (parent[k] != k) k = parent[k] = parent[parent[k]];
        return k;
    }
    void join(std::uint32_t a, std::uint32_t b) { parent[root(a)] = root(b); }
};

/// Triangles of a cell by a corner and the axis that they face along.
class FacingCorners {
public:
    explicit FacingCorners(std::size_t triangles) : slots_(std::bit_ceil(6 * triangles + 1)) {}
    /// Returns a triangle that was added with this corner and axis, or kNoCell; then adds it.
    std::uint32_t add(vec3 corner, std::uint32_t axis, std::uint32_t triangle)
    {
        std::uint32_t hash = axis;
        for (int k = 0; k < 3; ++k)
            hash = hash_words(hash, std::bit_cast<std::uint32_t>(corner[k] + 0.0f)); // no -0
        for (std::size_t i = hash;; ++i) {
            Slot& slot = slots_[i & (slots_.size() - 1)];
            if (slot.triangle != kNoCell && (slot.corner != corner || slot.axis != axis)) continue;
            std::uint32_t const earlier = slot.triangle;
            if (earlier == kNoCell) slot = {corner, axis, triangle};
            return earlier;
        }
    }

private:
    struct Slot {
        vec3 corner{0};
        std::uint32_t axis = 0, triangle = kNoCell;
    };
    std::vector<Slot> slots_;
};

} // namespace

PatchTable find_patches(World const& world, VoxelGrid const& grid, Patches& all,
                        std::vector<std::uint32_t>& of_piece)
{
    std::size_t const cells = grid.blocks.values.size(), pieces = grid.pieces.size();
    // Pieces by cell, and by triangle in each.
    std::vector<std::uint32_t> order(pieces), first(cells + 1);
    for (SurfacePiece const& p : grid.pieces) ++first[p.block + 1];
    std::partial_sum(first.begin(), first.end(), first.begin());
    std::vector<std::uint32_t> next = first;
    for (std::uint32_t i = 0; i < pieces; ++i) order[next[grid.pieces[i].block]++] = i;

    PatchTable out;
    of_piece.resize(pieces);
    out.first_entry.resize(cells + 1);
    out.first_patch.resize(cells + 1);
    std::vector<std::vector<std::uint32_t>> triangles(cells), patches(cells);
    float const small = square(grid.blocks.frame.cell) / 20;
    tbb::parallel_for(std::size_t(0), cells, [&](std::size_t cell) {
        if (first[cell] == first[cell + 1]) return;
        std::span<std::uint32_t> const own{order.data() + first[cell], order.data() + first[cell + 1]};
        std::ranges::stable_sort(own, {}, [&](std::uint32_t i) { return grid.pieces[i].triangle; });
        std::vector<std::uint32_t>& of = triangles[cell];
        std::vector<vec3> area;
        for (std::uint32_t const i : own) {
            SurfacePiece const& p = grid.pieces[i];
            if (of.empty() || of.back() != p.triangle) {
                of.push_back(p.triangle);
                area.emplace_back(0);
            }
            area.back() += p.area * p.normal;
            of_piece[i] = std::uint32_t(of.size() - 1);
        }
        std::size_t const n = of.size();
        JoinedSets sets(n);
        std::vector<std::uint32_t> axis(n);
        for (std::uint32_t k = 0; k < n; ++k) axis[k] = main_axis(area[k]);
        FacingCorners corners(n);
        for (std::uint32_t k = 0; k < n; ++k)
            for (int c = 0; c < 3; ++c) {
                std::uint32_t const same = corners.add(world.positions[world.triangles[of[k]][c]], axis[k], k);
                if (same != kNoCell) sets.join(k, same);
            }
        std::vector<float> whole(n);
        for (std::uint32_t k = 0; k < n; ++k) whole[sets.root(k)] += glm::length(area[k]);
        std::uint32_t lump[6];
        std::ranges::fill(lump, kNoCell);
        for (std::uint32_t k = 0; k < n; ++k) {
            if (sets.root(k) != k || whole[k] >= small) continue;
            std::uint32_t& same = lump[axis[k]];
            if (same == kNoCell)
                same = k;
            else
                sets.join(k, same);
        }
        std::vector<std::uint32_t> number(n, kNoCell);
        std::uint32_t count = 0;
        for (std::uint32_t k = 0; k < n; ++k) {
            std::uint32_t& own_number = number[sets.root(k)];
            if (own_number == kNoCell) own_number = count++;
            patches[cell].push_back(own_number);
        }
        out.first_entry[cell + 1] = std::uint32_t(n);
        out.first_patch[cell + 1] = count;
    });
    std::partial_sum(out.first_entry.begin(), out.first_entry.end(), out.first_entry.begin());
    out.first_patch[0] = std::uint32_t(all.count());
    std::partial_sum(out.first_patch.begin(), out.first_patch.end(), out.first_patch.begin());
    out.triangles.reserve(out.first_entry.back());
    out.patches.reserve(out.first_entry.back());
    for (std::size_t cell = 0; cell < cells; ++cell) {
        for (std::uint32_t k = first[cell]; k < first[cell + 1]; ++k) {
            std::uint32_t& patch = of_piece[order[k]];
            patch = out.first_patch[cell] + patches[cell][patch];
        }
        out.triangles.insert(out.triangles.end(), triangles[cell].begin(), triangles[cell].end());
        all.cell_of_patch.resize(out.first_patch[cell + 1], std::uint32_t(cell));
        for (std::uint32_t const p : patches[cell]) out.patches.push_back(out.first_patch[cell] + p);
    }
    all.voxels.resize(all.count());
    for (std::size_t i = 0; i < pieces; ++i) all.voxels[of_piece[i]] |= BlockVoxels(1) << grid.pieces[i].voxel;
    return out;
}

} // namespace gi
