// The rasteriser's kernels, on the host and on the device, against the vector form of the CPU.

#include "gi/kernel/scan.h"
#include "gi/raster/deep_raster.h"
#include "gi/raster/draw_nearest.h"
#include "tests/raster/plain_raster.h"
#include "tests/support/closed_mesh.h"
#include "tests/support/on_device.h"

#include <algorithm>

namespace gi::test {
namespace {

using Fragment = std::tuple<std::uint32_t, std::uint32_t, float>; ///< texel, primitive, depth

/// As many shares for every triangle.
template <Space S>
RasterShares<S> equal_shares(TriangleSoup const& soup, std::uint32_t each)
{
    std::vector<std::uint32_t> before;
    for (std::uint32_t t = 0; t <= soup.count; ++t) before.push_back(t * (each - 1));
    return {upload<S>(before), soup.count * each, std::uint32_t(soup.count)};
}

/// Those that raster_shares chooses for one grid.
template <Space S>
RasterShares<S> chosen_shares(SoupOn<S> const& there, RasterGrid const& grid)
{
    Buffer<LayerRaster, S> const raster = upload<S>(std::vector<LayerRaster>{{grid, 0, 0, nullptr, nullptr}});
    return raster_shares<S>(there.view(), raster.view());
}

/// What CountLayers and FillLayers give.
template <Space S>
std::vector<Fragment> kernel_fragments(SoupOn<S> const& there, RasterGrid const& grid,
                                       RasterShares<S> const& shares)
{
    std::size_t const texels = grid.texels();
    Buffer<std::uint32_t, S> counts = upload<S>(std::vector<std::uint32_t>(texels + 1, 0)), offset(texels + 1),
                             next(texels + 1);
    Buffer<std::uint64_t, S> total = upload<S>(std::vector<std::uint64_t>{0});
    Buffer<LayerRaster, S> rasters =
        upload<S>(std::vector<LayerRaster>{{grid, 0, 0, offset.view().data, nullptr}});
    launch(S, "count layers", shares.items,
           CountLayers{there.view(), std::as_const(rasters).view(), shares.view(), counts.view(), total.view()});
    exclusive_scan(S, std::as_const(counts).view(), counts.view());
    Buffer<HitLayer, S> layers = upload<S>(std::vector<HitLayer>(download(total)[0], HitLayer{NAN, 0xffffffffu}));
    rasters = upload<S>(std::vector<LayerRaster>{{grid, 0, 0, offset.view().data, layers.view().data}});
    launch(S, "offsets of layers", texels + 1,
           StartLayers{std::as_const(rasters).view(), std::as_const(counts).view(), next.view(), {}});
    launch(S, "fill layers", shares.items,
           FillLayers{there.view(), std::as_const(rasters).view(), shares.view(), next.view()});

    std::vector<std::uint32_t> const first = download(offset), end = download(next);
    std::vector<HitLayer> const filled = download(layers);
    EXPECT_EQ(first[texels], filled.size());
    std::vector<Fragment> all;
    for (std::uint32_t t = 0; t < texels; ++t) {
        EXPECT_EQ(end[t], first[t + 1]);
        for (std::uint32_t k = first[t]; k < first[t + 1]; ++k)
            all.emplace_back(t, filled[k].primitive, filled[k].depth);
    }
    std::ranges::sort(all);
    return all;
}

std::vector<Fragment> sorted_layers(Fragments const& f)
{
    std::vector<Fragment> all;
    for (std::size_t k = 0; k < f.count; ++k) all.emplace_back(f.texel[k], f.primitive[k], f.depth[k]);
    std::ranges::sort(all);
    return all;
}

template <Space S>
void check_layers()
{
    Pcg32 rng(21, 0);
    for (int mesh = 0; mesh < 40; ++mesh) {
        World const world = random_closed_mesh(rng, mesh % 4, 0.8f);
        TriangleSoup const soup = make_soup(world);
        RasterGrid const grid = random_grid(world, rng, 5u << (mesh % 7));
        SoupOn<S> const there(soup);
        auto const found = kernel_fragments<S>(
            there, grid,
            mesh % 3 == 0 ? chosen_shares<S>(there, grid) : equal_shares<S>(soup, 1 + std::uint32_t(mesh % 11)));
        Fragments plain, vectors;
        rasterize_plain(soup, 0, soup.count, grid, MacroPath::linear_blocks, plain);
        ASSERT_EQ(found, sorted_layers(plain)); // bit for bit
        rasterize(soup, 0, soup.count, grid, MacroPath::edge_table, vectors);
        auto const expected = sorted_layers(vectors);
        ASSERT_EQ(found.size(), expected.size());
        for (std::size_t k = 0; k < found.size(); ++k) {
            ASSERT_EQ(std::get<0>(found[k]), std::get<0>(expected[k]));
            ASSERT_EQ(std::get<1>(found[k]), std::get<1>(expected[k]));
            ASSERT_NEAR(std::get<2>(found[k]), std::get<2>(expected[k]), 2e-3f * world.bounds.radius());
        }
    }
}
LIGHTWELL_TEST_BOTH(RasterKernels, LayersAreThoseOfTheCpu, check_layers);

template <Space S>
void check_nothing()
{
    World const world = world_of(Scene{});
    TriangleSoup const soup = make_soup(world);
    RasterGrid const grid = make_grid(world.bounds, vec3{0, 1, 0}, 16, {0, 0}, 0);
    SoupOn<S> const there(soup);
    EXPECT_TRUE(kernel_fragments<S>(there, grid, chosen_shares<S>(there, grid)).empty());
    std::vector<NearestTexel> const map = download(draw_nearest<S>(there.view(), grid));
    for (NearestTexel const& t : map) EXPECT_EQ(t.primitive, kNoPrimitive);
}
LIGHTWELL_TEST_BOTH(RasterKernels, NoTrianglesNoLayers, check_nothing);

template <Space S>
void check_one_triangle()
{
    Scene scene;
    Mesh& mesh = scene.meshes.emplace_back();
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 1}};
    mesh.triangles = {{0, 1, 2}};
    scene.nodes.emplace_back().meshes = {0};
    World const world = world_of(scene);
    TriangleSoup const soup = make_soup(world);
    RasterGrid const grid = make_grid(world.bounds, vec3{0, 0, 1}, 200, {0.2f, 0.7f}, 0.5f);
    SoupOn<S> const there(soup);
    Fragments plain;
    rasterize_plain(soup, 0, soup.count, grid, MacroPath::square_blocks, plain);
    EXPECT_GT(plain.count, 1000u);
    for (std::uint32_t const shares : {1u, 2u, 7u, 64u, 1000u})
        EXPECT_EQ(kernel_fragments<S>(there, grid, equal_shares<S>(soup, shares)), sorted_layers(plain));
    RasterShares<S> const chosen = chosen_shares<S>(there, grid);
    EXPECT_GT(chosen.items, 100u); // so that none of them has many samples
    EXPECT_EQ(kernel_fragments<S>(there, grid, chosen), sorted_layers(plain));
}
LIGHTWELL_TEST_BOTH(RasterKernels, OneTriangleInManyShares, check_one_triangle);

/// Every texel as in the map of the CPU, but for depths that rounding cannot tell apart.
void expect_same(std::vector<NearestTexel> const& found, NearestMap const& expected, std::string const& what)
{
    ASSERT_EQ(found.size(), expected.texels.size());
    std::size_t drawn = 0, differ = 0;
    for (std::size_t t = 0; t < found.size(); ++t) {
        NearestTexel const &a = found[t], &b = expected.texels[t];
        ASSERT_EQ(a.primitive == kNoPrimitive, b.primitive == kNoPrimitive) << what << " " << t;
        if (b.primitive == kNoPrimitive) continue;
        ++drawn;
        differ += a.primitive != b.primitive;
        ASSERT_NEAR(a.key, b.key, 1e-3f * (1 + std::abs(b.key))) << what << " " << t;
    }
    EXPECT_GT(drawn, 0u) << what;
    EXPECT_LE(differ, 1 + drawn / 100) << what;
}

template <Space S>
void check_nearest()
{
    Pcg32 rng(22, 0);
    for (int mesh = 0; mesh < 24; ++mesh) {
        World const world = random_closed_mesh(rng, 1 + mesh % 4, 0.6f);
        TriangleSoup const soup = make_soup(world);
        SoupOn<S> const there(soup);
        RasterGrid const grid = random_grid(world, rng, 8u << (mesh % 5));
        Fragments fragments;
        NearestMap map;
        rasterize(soup, 0, soup.count, grid, MacroPath::edge_table, fragments);
        clear(map, grid.width, grid.height);
        resolve(fragments, -1, map);
        expect_same(download(draw_nearest<S>(there.view(), grid)), map, "parallel");

        // From outside, and from within, where triangles are clipped.
        float const away = mesh % 2 == 0 ? 2.5f : 0.02f;
        vec3 const eye = world.bounds.center() + away * world.bounds.radius() * random_direction(rng);
        Camera const camera = look_at(dvec3(eye), dvec3(world.bounds.center()), 90);
        CameraRays const rays = camera_rays(camera, 90, 70, world.origin);
        PerspectiveGrid const view_grid = camera_grid(rays, 90, 70, rng.uniform2(), 1e-5f);
        fragments.count = 0;
        rasterize(soup, 0, soup.count, view_grid, fragments);
        clear(map, view_grid.width, view_grid.height);
        resolve(fragments, 1, map);
        expect_same(download(draw_nearest<S>(there.view(), view_grid)), map,
                    "perspective " + std::to_string(mesh));
    }
}
LIGHTWELL_TEST_BOTH(RasterKernels, NearestIsThatOfTheCpu, check_nearest);

template <Space S>
void check_ties()
{
    // The same square five times: the first one is in front.
    Scene scene;
    int const m = add_material(scene, lambert(vec3{0.5f}));
    for (int k = 0; k < 5; ++k) add_quad(scene, {-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, m);
    World const world = world_of(scene);
    TriangleSoup const soup = make_soup(world);
    RasterGrid const grid = make_grid(world.bounds, vec3{0, 0, 1}, 64, {0.5f, 0.5f}, 0);
    for (NearestTexel const& t : download(draw_nearest<S>(SoupOn<S>(soup).view(), grid)))
        EXPECT_TRUE(t.primitive < 2 || t.primitive == kNoPrimitive);
}
LIGHTWELL_TEST_BOTH(RasterKernels, OfEquallyNearOnesTheFirst, check_ties);

TEST(RasterKernels, FloatsKeepTheirOrderAsIntegers)
{
    using namespace raster_detail;
    float const values[] = {-kInf, -1e10f, -1, -1e-40f, 0.0f, 1e-40f, 1e-3f, 1, 3e30f, kInf};
    for (std::size_t k = 0; k < std::size(values); ++k) {
        EXPECT_EQ(from_ordered_bits(ordered_bits(values[k])), values[k]);
        EXPECT_NE(ordered_bits(values[k]), 0u);
        EXPECT_TRUE(k == 0 || ordered_bits(values[k - 1]) < ordered_bits(values[k]));
    }
    EXPECT_EQ(ordered_bits(-0.0f), ordered_bits(0.0f));
}

template <Space S>
void check_scan()
{
    Pcg32 rng(23, 0);
    for (std::size_t const n : {std::size_t(0), std::size_t(1), std::size_t(255), std::size_t(300'001)}) {
        std::vector<std::uint32_t> in(n), expected(n);
        std::uint32_t sum = 0;
        for (std::size_t k = 0; k < n; ++k) {
            in[k] = rng.next() % 1000;
            expected[k] = sum;
            sum += in[k];
        }
        Buffer<std::uint32_t, S> const from = upload<S>(in);
        Buffer<std::uint32_t, S> to(n), both = upload<S>(in);
        exclusive_scan(S, from.view(), to.view());
        EXPECT_EQ(download(to), expected);
        exclusive_scan(S, std::as_const(both).view(), both.view());
        EXPECT_EQ(download(both), expected);
    }
}
LIGHTWELL_TEST_BOTH(Scan, IsThePrefixSum, check_scan);

} // namespace
} // namespace gi::test
