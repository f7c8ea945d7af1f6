// The deep rasteriser: watertight by exact arithmetic; all its variants give the same result.

#include "gi/raster/deep_raster.h"
#include "tests/raster/plain_raster.h"
#include "tests/support/closed_mesh.h"

#include <algorithm>
#include <fmt/format.h>
#include <gtest/gtest.h>

namespace gi::test {
namespace {

using Fragment = std::tuple<std::uint32_t, std::uint32_t, float>; ///< texel, primitive, depth

std::vector<Fragment> sorted(Fragments const& f)
{
    std::vector<Fragment> all;
    for (std::size_t k = 0; k < f.count; ++k) all.emplace_back(f.texel[k], f.primitive[k], f.depth[k]);
    std::ranges::sort(all);
    return all;
}

/// Zero where as many fragments run along the axis as against it.
std::vector<int> balance(Fragments const& f, RasterGrid const& grid, std::vector<int>* layers = nullptr)
{
    std::vector<int> sum(grid.texels(), 0);
    if (layers != nullptr) layers->assign(grid.texels(), 0);
    for (std::size_t k = 0; k < f.count; ++k) {
        sum[f.texel[k]] += (f.primitive[k] & kAlongAxis) != 0 ? 1 : -1;
        if (layers != nullptr) ++(*layers)[f.texel[k]];
    }
    return sum;
}

TEST(DeepRaster, ClosedMeshesHaveNeitherHolesNorDoubles)
{
    Pcg32 rng(11, 0);
    for (int mesh = 0; mesh < 600; ++mesh) { // lightwell bench raster does it with 10,000
        bool const convex = mesh % 2 == 0;
        World const world = random_closed_mesh(rng, 1 + mesh % 3, convex ? 0.0f : 1.5f);
        TriangleSoup const soup = make_soup(world);
        RasterGrid const grid = random_grid(world, rng, 8u << (mesh % 5));
        Fragments f;
        rasterize(soup, 0, soup.count, grid, MacroPath::edge_table, f);
        std::vector<int> layers;
        for (int const b : balance(f, grid, &layers)) ASSERT_EQ(b, 0) << "mesh " << mesh;
        EXPECT_GT(f.count, 0u);
        if (!convex) continue;
        for (std::uint32_t j = 0; j < grid.height; ++j) { // two layers, side by side
            int runs = 0;
            for (std::uint32_t i = 0; i < grid.width; ++i) {
                int const n = layers[j * grid.width + i];
                ASSERT_TRUE(n == 0 || n == 2) << n;
                runs += n > 0 && (i == 0 || layers[j * grid.width + i - 1] == 0);
            }
            ASSERT_LE(runs, 1);
        }
    }
}

TEST(DeepRaster, AllFormsGiveTheSameFragments)
{
    Pcg32 rng(12, 0);
    for (int mesh = 0; mesh < 60; ++mesh) {
        World const world = random_closed_mesh(rng, mesh % 4, 0.8f);
        TriangleSoup const soup = make_soup(world);
        RasterGrid const grid = random_grid(world, rng, 5u << (mesh % 7));
        Fragments expected;
        rasterize_plain(soup, 0, soup.count, grid, MacroPath::square_blocks, expected);
        auto const truth = sorted(expected);
        float const extent = world.bounds.radius();
        for (MacroPath const path : {MacroPath::edge_table, MacroPath::linear_blocks, MacroPath::square_blocks}) {
            Fragments f;
            rasterize(soup, 0, soup.count, grid, path, f);
            auto const found = sorted(f);
            ASSERT_EQ(found.size(), truth.size());
            for (std::size_t k = 0; k < truth.size(); ++k) {
                ASSERT_EQ(std::get<0>(found[k]), std::get<0>(truth[k]));
                ASSERT_EQ(std::get<1>(found[k]), std::get<1>(truth[k]));
                ASSERT_NEAR(std::get<2>(found[k]), std::get<2>(truth[k]), 2e-3f * extent);
            }
        }
    }
}

TEST(DeepRaster, SquareBlocksFindTheTriangleThatTouchesNoCornerOfItsBlock)
{
    // Over sample (5, 6) alone, within the block of 4 x 4 samples whose corners are (4, 4) and (7, 7).
    constexpr std::int32_t kSubpixels = 256;
    auto const at = [](double texel) { return std::int32_t(texel * kSubpixels); };
    // A long thin one makes the bounds begin at (0, 0) in the second case.
    SnappedTriangle const small{{at(5.2), at(5.8), at(5.5)}, {at(6.3), at(6.4), at(6.9)}};
    SnappedTriangle const long_one{{at(0.6), at(11.9), at(0.7)}, {at(0.55), at(11.4), at(1.7)}};
    for (SnappedTriangle const& t : {small, long_one}) {
        TriangleScan const s = start_scan(t, kSubpixels, 64, 64);
        auto const covered = [&](MacroPath path) {
            std::vector<std::pair<std::uint32_t, std::uint32_t>> samples;
            scan(s, path, [&](std::uint32_t j, std::uint32_t first, std::uint32_t last) {
                for (std::uint32_t i = first; i <= last; ++i) samples.emplace_back(j, i);
            });
            std::ranges::sort(samples);
            return samples;
        };
        auto const truth = covered(MacroPath::edge_table);
        EXPECT_FALSE(truth.empty());
        EXPECT_EQ(covered(MacroPath::square_blocks), truth);
        EXPECT_EQ(covered(MacroPath::linear_blocks), truth);
    }
}

TEST(DeepRaster, AxisAlignedSquaresTileThePlane)
{
    // Edges and corners run exactly through samples.
    Scene scene;
    int const m = add_material(scene, lambert(vec3{0.5f}));
    for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 8; ++x) add_quad(scene, {float(x), float(y), 0}, {1, 0, 0}, {0, 1, 0}, m);
    World const world = world_of(scene);
    TriangleSoup const soup = make_soup(world);
    RasterGrid g;
    g.width = g.height = 16;
    g.texel = 0.5f;
    g.corner = vec2{-0.25f};
    g.subpixels = 1024;
    g.to_x = {2048, 0, 0};
    g.to_y = {0, 2048, 0};
    g.x0 = g.y0 = 512;
    Fragments f;
    rasterize(soup, 0, soup.count, g, MacroPath::edge_table, f);
    std::vector<int> count(g.texels(), 0);
    for (std::size_t k = 0; k < f.count; ++k) ++count[f.texel[k]];
    for (int const n : count) EXPECT_EQ(n, 1);
}

TEST(DeepRaster, DepthIsThatOfThePlane)
{
    Pcg32 rng(13, 0);
    for (int k = 0; k < 200; ++k) {
        Scene scene;
        Mesh& mesh = scene.meshes.emplace_back();
        for (int v = 0; v < 3; ++v)
            mesh.positions.push_back(10.0f * vec3{rng.uniform(), rng.uniform(), rng.uniform()});
        mesh.triangles = {{0, 1, 2}};
        scene.nodes.emplace_back().meshes = {0};
        World const world = world_of(scene);
        TriangleSoup const soup = make_soup(world);
        RasterGrid const grid = random_grid(world, rng, 3u << (k % 6));
        vec3 const n = glm::normalize(
            glm::cross(soup.vertex(0, 1) - soup.vertex(0, 0), soup.vertex(0, 2) - soup.vertex(0, 0)));
        float const steep = 1 / std::abs(glm::dot(n, grid.axis));
        Fragments f;
        rasterize(soup, 0, soup.count, grid, MacroPath::edge_table, f);
        for (std::size_t i = 0; i < f.count; ++i) {
            vec3 const p = grid.point(f.texel[i] % grid.width, f.texel[i] / grid.width, f.depth[i]);
            EXPECT_NEAR(glm::dot(n, p - soup.vertex(0, 0)) * steep, 0, 1e-5f * steep + 3e-4f);
            EXPECT_EQ((f.primitive[i] & kAlongAxis) != 0, glm::dot(n, grid.axis) > 0);
        }
    }
}

} // namespace
} // namespace gi::test
