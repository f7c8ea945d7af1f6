// Hit buffers and queries as kernels, on the host and on the device, against the CPU's own forms.

#include "gi/hit_buffers/build_hit_buffer.h"
#include "gi/hit_buffers/query_batch.h"
#include "tests/raster/plain_raster.h"
#include "tests/support/closed_mesh.h"
#include "tests/support/on_device.h"

#include <algorithm>

namespace gi::test {
namespace {

/// The plain rasteriser and the CPU's own sort.
HitBuffer expected_buffer(TriangleSoup const& soup, RasterGrid const& grid, std::uint32_t most_layers = 0)
{
    Fragments f;
    rasterize_plain(soup, 0, soup.count, grid, MacroPath::edge_table, f);
    HitBuffer b;
    fill_hit_buffer(f, grid, most_layers, b);
    return b;
}

template <Space S>
void expect_equal(HitBufferOn<S> const& found, HitBuffer const& expected)
{
    ASSERT_EQ(download(found.offset), expected.offset);
    std::vector<HitLayer> const layers = download(found.layers);
    ASSERT_EQ(layers.size(), expected.layers.size());
    EXPECT_EQ(found.lost, expected.lost);
    for (std::size_t k = 0; k < layers.size(); ++k) {
        ASSERT_EQ(layers[k].primitive, expected.layers[k].primitive) << k;
        ASSERT_EQ(std::bit_cast<std::uint32_t>(layers[k].depth),
                  std::bit_cast<std::uint32_t>(expected.layers[k].depth))
            << k;
    }
}

template <Space S>
void check_build()
{
    Pcg32 rng(31, 0);
    for (int mesh = 0; mesh < 40; ++mesh) {
        World const world = random_closed_mesh(rng, mesh % 5, 1.5f);
        TriangleSoup const soup = make_soup(world);
        RasterGrid const grid = random_grid(world, rng, 4u << (mesh % 7));
        auto const most = std::uint32_t(mesh % 4 == 3 ? 1 + mesh % 3 : 0);
        expect_equal(build_hit_buffer<S>(SoupOn<S>(soup).view(), grid, most), expected_buffer(soup, grid, most));
    }
}
LIGHTWELL_TEST_BOTH(SlhbKernels, BuffersAreThoseOfTheCpu, check_build);

/// Buffers of several grids that are built in the same launches.
template <Space S>
void check_together()
{
    Pcg32 rng(34, 0);
    World const world = random_closed_mesh(rng, 4, 1.5f);
    TriangleSoup const soup = make_soup(world);
    SoupOn<S> const there(soup);
    std::vector<RasterGrid> grids;
    for (std::uint32_t k = 0; k < 9; ++k) grids.push_back(random_grid(world, rng, 3u << (k * 5 % 7)));
    std::vector<std::uint32_t> const seeds(grids.size(), 0);
    for (std::uint32_t const most : {0u, 2u}) {
        DeviceWork const before = device_work();
        auto const found = build_hit_buffers<S>(there.view(), grids, seeds, most);
        DeviceWork work = device_work();
        work -= before;
        ASSERT_EQ(found.size(), grids.size());
        for (std::size_t k = 0; k < grids.size(); ++k) {
            HitBuffer const expected = expected_buffer(soup, grids[k], most);
            ASSERT_EQ(found[k].grid.width, grids[k].width);
            expect_equal(found[k], expected);
        }
        EXPECT_EQ(work.launches, S == Space::host ? 0u : most == 0 ? 9u : 14u);
    }
    EXPECT_TRUE(build_hit_buffers<S>(there.view(), {}, {}).empty());
}
LIGHTWELL_TEST_BOTH(SlhbKernels, BuffersOfManyGridsAreBuiltTogether, check_together);

template <Space S>
void check_no_layers()
{
    World const world = world_of(Scene{});
    RasterGrid const grid = make_grid(world.bounds, vec3{0, 1, 0}, 16, {0, 0}, 0);
    HitBufferOn<S> const b = build_hit_buffer<S>(SoupOn<S>(make_soup(world)).view(), grid);
    EXPECT_EQ(b.layers.size(), 0u);
    EXPECT_EQ(download(b.offset), (std::vector<std::uint32_t>(grid.texels() + 1, 0)));
}
LIGHTWELL_TEST_BOTH(SlhbKernels, NoTrianglesNoLayers, check_no_layers);

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
    for (vec3 const axis : {vec3{0, 0, 1}, vec3{0, 0, -1}, vec3{1, 0, 0}}) {
        RasterGrid const grid = make_grid(world.bounds, axis, 50, {0.2f, 0.7f}, 0.5f);
        expect_equal(build_hit_buffer<S>(SoupOn<S>(soup).view(), grid), expected_buffer(soup, grid));
    }
}
LIGHTWELL_TEST_BOTH(SlhbKernels, OneTriangle, check_one_triangle);

template <Space S>
void check_many_layers()
{
    Scene scene;
    int const m = add_material(scene, lambert(vec3{0.5f}));
    for (int k = 0; k < 10000; ++k) // every depth twice
        add_quad(scene, {-1, -1, 1e-3f * float(k * 7919 % 5000)}, {2, 0, 0}, {0, 2, 0}, m);
    World const world = world_of(scene);
    TriangleSoup const soup = make_soup(world);
    RasterGrid const grid = make_grid(world.bounds, vec3{0, 0, 1}, 4, {0.5f, 0.5f}, 0);
    HitBuffer const expected = expected_buffer(soup, grid);
    std::size_t const middle = grid.width / 2 + std::size_t(grid.height / 2) * grid.width;
    ASSERT_EQ(expected.offset[middle + 1] - expected.offset[middle], 10000u);
    expect_equal(build_hit_buffer<S>(SoupOn<S>(soup).view(), grid), expected);
    expect_equal(build_hit_buffer<S>(SoupOn<S>(soup).view(), grid, 100), expected_buffer(soup, grid, 100));
}
LIGHTWELL_TEST_BOTH(SlhbKernels, TenThousandLayersUnderOneTexel, check_many_layers);

/// Sorts texels with these numbers of layers.
template <Space S>
void check_sort()
{
    Pcg32 rng(32, 0);
    std::vector<std::uint32_t> offset{0};
    for (std::uint32_t n = 0; n < 60; ++n) offset.push_back(offset.back() + n);
    // 20,000 layers: half a million steps, or 200 million if it were quadratic.
    for (std::uint32_t const n : {0u, 1u, 1000u, 20'000u}) offset.push_back(offset.back() + n);
    for (int order = 0; order < 4; ++order) { // random, few depths, rising, falling
        std::vector<HitLayer> layers(offset.back());
        for (std::uint32_t k = 0; k < layers.size(); ++k) {
            float const depth = order == 0   ? rng.uniform() - 0.5f
                                : order == 1 ? float(rng.next() % 3)
                                : order == 2 ? float(k)
                                             : -float(k);
            layers[k] = {depth, rng.next()};
        }
        std::vector<HitLayer> expected = layers;
        for (std::size_t t = 0; t + 1 < offset.size(); ++t)
            std::sort(expected.begin() + offset[t], expected.begin() + offset[t + 1], before);
        Buffer<std::uint32_t, S> there = upload<S>(offset);
        Buffer<HitLayer, S> sorted = upload<S>(layers);
        RasterGrid row;
        row.width = std::uint32_t(offset.size()) - 1;
        Buffer<LayerRaster, S> const raster =
            upload<S>(std::vector<LayerRaster>{{row, 0, 0, there.view().data, sorted.view().data}});
        launch(S, "sort layers", offset.size(), SortLayers{raster.view()});
        std::vector<HitLayer> const found = download(sorted);
        for (std::size_t k = 0; k < found.size(); ++k) {
            ASSERT_EQ(found[k].primitive, expected[k].primitive) << order << " " << k;
            ASSERT_EQ(found[k].depth, expected[k].depth) << order << " " << k;
        }
    }
}
LIGHTWELL_TEST_BOTH(SlhbKernels, SortsByDepthThenPrimitive, check_sort);

template <Space S>
void check_queries()
{
    constexpr std::size_t kQueries = 20'000, kAxes = 6;
    Pcg32 rng(33, 0);
    for (int mesh = 0; mesh < 4; ++mesh) {
        World const world = random_closed_mesh(rng, 2 + mesh, 0.7f);
        TriangleSoup const soup = make_soup(world);
        SoupOn<S> const there(soup);
        std::vector<HitBuffer> buffers;
        std::vector<HitBufferOn<S>> kernels;
        std::vector<AxisView> axes;
        for (std::size_t a = 0; a < kAxes; ++a) {
            RasterGrid const grid = random_grid(world, rng, 24 + 30 * std::uint32_t(a));
            buffers.push_back(expected_buffer(soup, grid));
            kernels.push_back(build_hit_buffer<S>(there.view(), grid));
            axes.push_back({{kernels.back().view(), {}}});
        }
        AxisPool pool;
        fill_pool(buffers, pool);
        QueryBatch batch;
        batch.resize(kQueries);
        for (std::size_t k = 0; k < kQueries; ++k) {
            auto const a = std::uint32_t(rng.next() % kAxes),
                       t = std::uint32_t(rng.next() % world.triangles.size());
            Surface const& s = world.surfaces[t];
            vec2 u = rng.uniform2();
            if (u.x + u.y > 1) u = 1.0f - u;
            float const cosine = glm::dot(glm::normalize(glm::cross(s.edge1, s.edge2)), pool.grids[a].axis);
            float const slope = std::sqrt(std::max(0.0f, 1 - cosine * cosine)) / std::max(std::abs(cosine), 1e-6f);
            batch.set(k,
                      {s.corner + u.x * s.edge1 + u.y * s.edge2, t, cosine > 0,
                       (cosine > 0) == (rng.uniform() < 0.3f), slope},
                      a);
        }
        Buffer<AxisView, S> const axes_there = upload<S>(axes);
        Buffer<Surface, S> const surfaces = upload<S>(world.surfaces);
        Buffer<float, S> const x = upload<S>(batch.x), y = upload<S>(batch.y), z = upload<S>(batch.z),
                               slope = upload<S>(batch.slope);
        Buffer<std::uint32_t, S> const triangle = upload<S>(batch.triangle), axis = upload<S>(batch.axis);
        Buffer<float, S> hit_x(kQueries), hit_y(kQueries), hit_z(kQueries);
        Buffer<std::uint32_t, S> hit(kQueries);
        launch(S, "answer queries", kQueries,
               AnswerQueries{axes_there.view(), surfaces.view(), x.view(), y.view(), z.view(), triangle.view(),
                             slope.view(), axis.view(), hit_x.view(), hit_y.view(), hit_z.view(), hit.view()});
        nearest_layers(pool, world.surfaces, batch);
        std::vector<std::uint32_t> const found = download(hit);
        std::vector<float> const fx = download(hit_x), fy = download(hit_y), fz = download(hit_z);
        std::size_t differ = 0, hits = 0;
        for (std::size_t k = 0; k < kQueries; ++k) {
            differ += found[k] != batch.hit[k];
            if (found[k] != batch.hit[k] || found[k] == kNoLayerHit) continue;
            ++hits;
            float const near = 1e-4f * world.bounds.radius();
            EXPECT_NEAR(fx[k], batch.hit_x[k], near);
            EXPECT_NEAR(fy[k], batch.hit_y[k], near);
            EXPECT_NEAR(fz[k], batch.hit_z[k], near);
        }
        // Rounding decides which texel or layer is nearest where two are equally near.
        EXPECT_LE(differ, kQueries / 1000);
        EXPECT_GT(hits, kQueries / 20);
    }
}
LIGHTWELL_TEST_BOTH(SlhbKernels, QueriesAreAnsweredAsByTheCpu, check_queries);

} // namespace
} // namespace gi::test
