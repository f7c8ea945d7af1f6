// The voxeliser against exact overlap of triangles and boxes, and what it does with hard geometry.

#include "gi/core/error.h"
#include "gi/core/rng.h"
#include "gi/methods/sh_grid/patches.h"
#include "gi/scene/load/load.h"
#include "tests/support/data.h"
#include "tests/support/scenes.h"

#include <filesystem>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <set>

namespace gi::test {
namespace {

/// Distance of a triangle from the unit box at a corner, as far as one of the separating axes (Akenine-Moeller
/// 2001) tells; below 0 = they overlap.
double separation(std::array<dvec3, 3> v, dvec3 corner)
{
    double gap = -1e300;
    std::vector<dvec3> axes{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, glm::cross(v[1] - v[0], v[2] - v[0])};
    for (int k = 0; k < 3; ++k)
        for (int a = 0; a < 3; ++a) {
            dvec3 e{0};
            e[a] = 1;
            axes.push_back(glm::cross(e, v[std::size_t(k + 1) % 3] - v[std::size_t(k)]));
        }
    for (dvec3 axis : axes) {
        double const length = glm::length(axis);
        if (!(length > 1e-12)) continue;
        axis /= length;
        double low = 1e300, high = -1e300;
        for (dvec3 const p : v) {
            double const d = glm::dot(p - corner, axis);
            low = std::min(low, d);
            high = std::max(high, d);
        }
        double box_low = 0, box_high = 0;
        for (int a = 0; a < 3; ++a) (axis[a] > 0 ? box_high : box_low) += axis[a];
        gap = std::max({gap, low - box_high, box_low - high});
    }
    return gap;
}

struct Misses {
    std::size_t marked = 0, missed = 0, wrong = 0;
};

/// Compares all voxels about each triangle.
Misses compare(World const& world, int voxels)
{
    VoxelGrid all = empty_voxel_grid(world.bounds, voxels);
    add_triangles(world, 0, world.triangles.size(), all);
    GridFrame const& frame = all.blocks.frame;
    CellsView<BlockVoxels> const blocks = all.blocks.view();
    auto const marked = [&](glm::ivec3 v) {
        BlockVoxels const* const block = blocks.find(v / 4);
        glm::ivec3 const in = v % 4;
        return block != nullptr && (*block >> (in.x + 4 * in.y + 16 * in.z) & 1) != 0;
    };
    Misses m;
    m.marked = count_voxels(all.blocks);
    std::set<std::tuple<int, int, int>> allowed;
    for (uvec3 const t : world.triangles) {
        std::array<dvec3, 3> v;
        dvec3 low{1e300}, high{-1e300};
        for (int k = 0; k < 3; ++k) {
            v[std::size_t(k)] = (dvec3(world.positions[t[k]]) - dvec3(frame.low)) / double(all.voxel_m());
            low = glm::min(low, v[std::size_t(k)]);
            high = glm::max(high, v[std::size_t(k)]);
        }
        if (!(glm::length(glm::cross(v[1] - v[0], v[2] - v[0])) > 1e-9)) continue;
        for (int z = int(low.z) - 1; z <= int(high.z) + 1; ++z)
            for (int y = int(low.y) - 1; y <= int(high.y) + 1; ++y)
                for (int x = int(low.x) - 1; x <= int(high.x) + 1; ++x) {
                    if (x < 0 || y < 0 || z < 0) continue;
                    double const gap = separation(v, {x, y, z});
                    if (gap < 1e-3) allowed.insert({x, y, z});
                    if (gap < 0 && !marked({x, y, z})) ++m.missed;
                }
    }
    for (std::uint32_t const cell : all.blocks.cells)
        for (int k = 0; k < 64; ++k) {
            glm::ivec3 const voxel = 4 * frame.cell_of(cell) + glm::ivec3{k % 4, k / 4 % 4, k / 16};
            if (marked(voxel) && !allowed.contains({voxel.x, voxel.y, voxel.z})) ++m.wrong;
        }
    return m;
}

TEST(Voxels, MissNoOverlapOfRandomTriangles)
{
    Pcg32 rng(5, 1);
    Scene scene;
    int const matt = add_material(scene, lambert(vec3{0.5f}));
    auto const within = [&](float scale) {
        return scale * (vec3{rng.uniform(), rng.uniform(), rng.uniform()} - 0.5f);
    };
    for (int k = 0; k < 5000; ++k) { // pairs of triangles, from a hundredth of a voxel to half the grid
        float const size = std::pow(10.0f, -3.5f + 3.2f * rng.uniform());
        add_quad(scene, within(1), within(size), within(size), matt);
    }
    World const world = world_of(scene);
    ASSERT_EQ(world.triangles.size(), 10000u);
    Misses const m = compare(world, 64);
    EXPECT_EQ(m.missed, 0u);
    EXPECT_EQ(m.wrong, 0u);
    EXPECT_GT(m.marked, 20000u);
}

TEST(Voxels, MissNoneOfHardMeshes)
{
    namespace fs = std::filesystem;
    fs::path const folder = shared_data() / "hard_meshes";
    LIGHTWELL_NEED_DATA(folder);
    std::size_t files = 0;
    Misses all;
    for (auto const& entry : fs::recursive_directory_iterator(folder)) {
        static std::set<std::string> const meshes{".obj", ".ply", ".stl", ".off", ".glb", ".gltf"};
        if (!entry.is_regular_file() || !meshes.contains(entry.path().extension().string())) continue;
        Report report;
        try {
            auto const scene = std::make_shared<Scene const>(load_scene(entry.path().string(), report));
            World const world = build_world(scene, std::nullopt, report);
            if (world.bounds.empty() || world.triangles.size() > 100000) continue;
            Misses const m = compare(world, 32);
            EXPECT_EQ(m.missed, 0u) << entry.path();
            all.marked += m.marked;
            all.missed += m.missed;
            all.wrong += m.wrong;
            ++files;
        } catch (InputError const&) { // refused
        }
    }
    fmt::print("{} files, {} voxels, {} missed, {} not near a triangle\n", files, all.marked, all.missed,
               all.wrong);
    EXPECT_GE(files, 20u);
    EXPECT_EQ(all.wrong, 0u);
}

/// Planes along the borders of voxels, which rounding could put on either side, or neither.
TEST(Voxels, MissNoneAlongBorders)
{
    Scene scene;
    int const matt = add_material(scene, lambert(vec3{0.5f}));
    add_box(scene, {-1, -1, -1}, {1, 1, 1}, matt, true);
    VoxelGrid const grid = empty_voxel_grid(world_of(scene).bounds, 32);
    for (int k = 1; k < 30; ++k) {
        float const x = grid.blocks.frame.low.x + float(k) * grid.voxel_m();
        add_quad(scene, {x, -1, -1}, {0, 2, 0}, {0, 0, 2}, matt);
    }
    World const world = world_of(scene);
    Misses const m = compare(world, 32);
    EXPECT_EQ(m.missed, 0u);
    EXPECT_EQ(m.wrong, 0u);
}

/// The pieces' areas sum to the triangles' areas, and each area belongs to one voxel.
TEST(Voxels, PiecesKeepArea)
{
    Scene scene;
    int const matt = add_material(scene, lambert(vec3{0.5f}));
    add_sphere(scene, vec3{0.1f, 0.2f, 0.3f}, 1, 4, matt, false);
    add_quad(scene, {-1, 0.01f, -1}, {2, 0, 0}, {0, 0.3f, 2}, matt);
    World const world = world_of(scene);
    double exact = 0;
    for (uvec3 const t : world.triangles)
        exact += 0.5 * glm::length(glm::cross(dvec3(world.positions[t.y]) - dvec3(world.positions[t.x]),
                                              dvec3(world.positions[t.z]) - dvec3(world.positions[t.x])));
    VoxelGrid grid = empty_voxel_grid(world.bounds, 100);
    add_triangles(world, 0, world.triangles.size(), grid);
    double sum = 0;
    for (SurfacePiece const& p : grid.pieces) sum += double(p.area);
    EXPECT_NEAR(sum / exact, 1, 1e-5);
}

TEST(Voxels, LeaveOutWhatIsNoSurface)
{
    Scene scene;
    int const matt = add_material(scene, lambert(vec3{0.5f}));
    add_box(scene, {-1, -1, -1}, {1, 1, 1}, matt, true);
    World const room = world_of(scene);
    add_quad(scene, {0, 0, 0}, {1, 0, 0}, {2, 0, 0}, matt); // no area
    add_sphere(scene, vec3{0}, 0.5f, 2, add_material(scene, glass(1.5f, false)), true);
    add_sphere(scene, vec3{0}, 0.3f, 2, add_material(scene, mirror(vec3{1})), true);
    World world = world_of(scene);
    VoxelGrid alone = empty_voxel_grid(room.bounds, 32), with = alone;
    add_triangles(room, 0, room.triangles.size(), alone);
    add_triangles(world, 0, world.triangles.size(), with);
    EXPECT_EQ(count_voxels(alone.blocks), count_voxels(with.blocks));
    world.positions[world.triangles.back().x] = vec3{std::nanf("")};
    world.positions[world.triangles.back().y] = vec3{1e30f};
    VoxelGrid broken = empty_voxel_grid(room.bounds, 32);
    add_triangles(world, 0, world.triangles.size(), broken);
    EXPECT_EQ(count_voxels(broken.blocks), count_voxels(alone.blocks));
}

TEST(Voxels, RefuseTooMany) { EXPECT_THROW(empty_voxel_grid({vec3{0}, vec3{1}}, 2048), InputError); }

/// A wall's two sides, and what lies behind, are patches of their own; a mesh that faces one way is one.
TEST(Voxels, PatchesAreWhatTouchesAndFacesTheSameWay)
{
    Scene scene;
    int const matt = add_material(scene, lambert(vec3{0.5f}));
    add_box(scene, {0, 0, 0}, {1, 0.01f, 1}, matt, false);
    World const world = world_of(scene);
    VoxelGrid grid = empty_voxel_grid(world.bounds, 32);
    add_triangles(world, 0, world.triangles.size(), grid);
    Patches patches;
    patches.first_moving = 1u << 20;
    std::vector<std::uint32_t> of_piece;
    patches.fixed = find_patches(world, grid, patches, of_piece);
    // In the middle: two quads of two triangles each.
    std::uint32_t const cell = grid.blocks.view().find_place(grid.blocks.frame.at({0.5f, 0.005f, 0.5f}));
    ASSERT_NE(cell, kNoCell);
    EXPECT_EQ(patches.fixed.first_patch[cell + 1] - patches.fixed.first_patch[cell], 2u);
    for (std::size_t i = 0; i < grid.pieces.size(); ++i) {
        SurfacePiece const& p = grid.pieces[i];
        EXPECT_EQ(patch_at(grid.blocks.view(), patches.view(), p.point, p.triangle), of_piece[i]);
    }
    EXPECT_EQ(patch_at(grid.blocks.view(), patches.view(), vec3{0.5f, 0.005f, 0.5f}, 1000), kNoCell);
}

} // namespace
} // namespace gi::test
