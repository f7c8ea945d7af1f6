#include "gi/methods/sh_grid/patches.h"

#include <algorithm>
#include <numeric>
#include <tbb/parallel_for.h>
#include <tuple>

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

struct Corner {
    vec3 position;
    std::uint32_t entry;
};

bool before(vec3 a, vec3 b) { return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z); }

} // namespace

PatchTable find_patches(World const& world, VoxelGrid const& grid, std::vector<std::uint32_t>& cell_of_patch,
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
        std::vector<Corner> corners;
        for (std::uint32_t k = 0; k < n; ++k)
            for (int c = 0; c < 3; ++c) corners.push_back({world.positions[world.triangles[of[k]][c]], k});
        std::ranges::sort(corners, before, &Corner::position);
        auto const axis = [&](std::uint32_t k) { return main_axis(area[k]); };
        for (std::size_t k = 0; k < corners.size();) {
            std::size_t end = k + 1;
            while (end < corners.size() && corners[end].position == corners[k].position) ++end;
            std::uint32_t last[6];
            std::ranges::fill(last, kNoCell);
            for (; k < end; ++k) {
                std::uint32_t const entry = corners[k].entry;
                std::uint32_t& same = last[axis(entry)];
                if (same != kNoCell) sets.join(entry, same);
                same = entry;
            }
        }
        std::vector<float> whole(n);
        for (std::uint32_t k = 0; k < n; ++k) whole[sets.root(k)] += glm::length(area[k]);
        std::uint32_t lump[6];
        std::ranges::fill(lump, kNoCell);
        for (std::uint32_t k = 0; k < n; ++k) {
            if (sets.root(k) != k || whole[k] >= small) continue;
            std::uint32_t& same = lump[axis(k)];
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
    out.first_patch[0] = std::uint32_t(cell_of_patch.size());
    std::partial_sum(out.first_patch.begin(), out.first_patch.end(), out.first_patch.begin());
    out.triangles.reserve(out.first_entry.back());
    out.patches.reserve(out.first_entry.back());
    for (std::size_t cell = 0; cell < cells; ++cell) {
        for (std::uint32_t k = first[cell]; k < first[cell + 1]; ++k) {
            std::uint32_t& patch = of_piece[order[k]];
            patch = out.first_patch[cell] + patches[cell][patch];
        }
        out.triangles.insert(out.triangles.end(), triangles[cell].begin(), triangles[cell].end());
        cell_of_patch.resize(out.first_patch[cell + 1], std::uint32_t(cell));
        for (std::uint32_t const p : patches[cell]) out.patches.push_back(out.first_patch[cell] + p);
    }
    return out;
}

} // namespace gi
