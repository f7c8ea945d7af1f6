#include "gi/core/rng.h"
#include "gi/hit_buffers/query_batch.h"
#include "gi/render/exact_visibility.h"
#include "tests/support/scenes.h"

#include <gtest/gtest.h>

namespace gi::test {
namespace {

World room_with_spheres()
{
    Scene scene;
    int const m = add_material(scene, lambert(vec3{0.5f}));
    add_box(scene, {-2, -2, -2}, {2, 2, 2}, m, true);
    add_sphere(scene, {-0.7f, -1, 0.2f}, 0.8f, 3, m, false);
    add_sphere(scene, {0.9f, 0.3f, -0.4f}, 0.6f, 2, m, false);
    return world_of(scene);
}

TEST(HitBuffer, HoldsEveryFragmentSortedByDepth)
{
    World const world = room_with_spheres();
    TriangleSoup const soup = make_soup(world);
    RasterGrid const grid = make_grid(world.bounds, glm::normalize(vec3{0.3f, 0.5f, 0.8f}), 40, {0.3f, 0.6f}, 1);
    Fragments f;
    rasterize(soup, 0, soup.count, grid, MacroPath::edge_table, f);
    HitBuffer b;
    fill_hit_buffer(f, grid, 0, b);
    EXPECT_EQ(b.layers.size(), f.count);
    EXPECT_EQ(b.lost, 0u);
    EXPECT_EQ(b.offset.front(), 0u);
    EXPECT_EQ(b.offset.back(), f.count);
    for (std::size_t t = 0; t < grid.texels(); ++t) {
        int balance = 0;
        for (std::uint32_t k = b.offset[t]; k < b.offset[t + 1]; ++k) {
            EXPECT_TRUE(k == b.offset[t] || b.layers[k - 1].depth <= b.layers[k].depth);
            balance += (b.layers[k].primitive & kAlongAxis) != 0 ? 1 : -1;
        }
        EXPECT_EQ(balance, 0);
    }
}

TEST(HitBuffer, ALimitOfLayersIsCounted)
{
    World const world = room_with_spheres();
    TriangleSoup const soup = make_soup(world);
    RasterGrid const grid = make_grid(world.bounds, vec3{0, 0, 1}, 32, {0.5f, 0.5f}, 0);
    HitBuffer const all = make_hit_buffer(soup, grid);
    HitBuffer const two = make_hit_buffer(soup, grid, MacroPath::edge_table, 2);
    EXPECT_GT(two.lost, 0u);
    EXPECT_EQ(two.layers.size() + two.lost, all.layers.size());
    for (std::size_t t = 0; t < grid.texels(); ++t) EXPECT_LE(two.offset[t + 1] - two.offset[t], 2u);
}

TEST(HitBuffer, TenThousandLayersUnderOneTexel)
{
    Scene scene;
    int const m = add_material(scene, lambert(vec3{0.5f}));
    for (int k = 0; k < 10000; ++k)
        add_quad(scene, {-1, -1, 1e-3f * float(k * 7919 % 10000)}, {2, 0, 0}, {0, 2, 0}, m);
    World const world = world_of(scene);
    TriangleSoup const soup = make_soup(world);
    RasterGrid const grid = make_grid(world.bounds, vec3{0, 0, 1}, 4, {0.5f, 0.5f}, 0);
    HitBuffer const b = make_hit_buffer(soup, grid);
    std::size_t const middle = grid.width / 2 + std::size_t(grid.height / 2) * grid.width;
    ASSERT_EQ(b.offset[middle + 1] - b.offset[middle], 10000u);
    for (std::uint32_t k = b.offset[middle] + 1; k < b.offset[middle + 1]; ++k)
        ASSERT_LE(b.layers[k - 1].depth, b.layers[k].depth);
}

TEST(HitBuffer, NothingIsNothing)
{
    World const world = world_of(Scene{});
    HitBuffer const b = make_hit_buffer(make_soup(world), make_grid(world.bounds, vec3{0, 1, 0}, 16, {0, 0}, 0));
    EXPECT_TRUE(b.layers.empty());
    AxisPool pool;
    fill_pool({b}, pool);
    QueryBatch batch;
    batch.resize(3);
    for (std::size_t k = 0; k < 3; ++k) batch.set(k, {{0, 0, 0}, 0, true, true, 0}, 0);
    nearest_layers(pool, {}, batch);
    for (std::uint32_t const hit : batch.hit) EXPECT_EQ(hit, kNoLayerHit);
}

/// Random origins on the triangles of a world.
WalkOrigin random_origin(World const& world, vec3 axis, Pcg32& rng)
{
    auto const t = std::uint32_t(rng.next() % world.triangles.size());
    Surface const& s = world.surfaces[t];
    vec2 u = rng.uniform2();
    if (u.x + u.y > 1) u = 1.0f - u;
    vec3 const n = glm::normalize(glm::cross(s.edge1, s.edge2));
    float const cosine = glm::dot(n, axis);
    bool const front = rng.uniform() < 0.8f; // leave on this side
    return {s.corner + u.x * s.edge1 + u.y * s.edge2, t, cosine > 0, (cosine > 0) == front,
            std::sqrt(std::max(0.0f, 1 - cosine * cosine)) / std::max(std::abs(cosine), 1e-6f)};
}

TEST(Query, VectorsAnswerAsThePlainForm)
{
    World const world = room_with_spheres();
    TriangleSoup const soup = make_soup(world);
    Pcg32 rng(3, 3);
    std::vector<HitBuffer> buffers;
    for (int a = 0; a < 7; ++a) {
        vec3 const axis = glm::normalize(vec3{rng.uniform() - 0.5f, rng.uniform() - 0.5f, rng.uniform() - 0.5f});
        buffers.push_back(make_hit_buffer(
            soup, make_grid(world.bounds, axis, 24 + 9 * std::uint32_t(a), rng.uniform2(), 6 * rng.uniform())));
    }
    AxisPool pool;
    fill_pool(buffers, pool);
    for (std::size_t const n : {1, 5, 16, 17, 4000}) {
        QueryBatch mixed;
        mixed.checked = true;
        mixed.resize(n);
        std::vector<QueryBatch> single(pool.size());
        for (std::size_t k = 0; k < n; ++k) {
            std::size_t const a = k % pool.size();
            mixed.set(k, random_origin(world, pool.grids[a].axis, rng), std::uint32_t(a));
        }
        nearest_layers(pool, world.surfaces, mixed);
        std::size_t differ = 0, doubts_differ = 0;
        for (std::size_t k = 0; k < n; ++k) {
            std::size_t const a = mixed.axis[k];
            LayerHit const plain = nearest_layer(pool.axis(a), world.surfaces, mixed.origin(k));
            bool const doubtful = is_doubtful(pool.axis(a), world.surfaces, mixed.origin(k), plain);
            doubts_differ += doubtful != (mixed.doubtful[k] != 0);
            QueryBatch alone;
            alone.resize(1);
            alone.set(0, mixed.origin(k), 0);
            nearest_layers(pool, a, world.surfaces, alone);
            EXPECT_EQ(alone.hit[0], mixed.hit[k]);
            // Fused products may put a depth on the other side of a comparison.
            std::uint32_t const expected =
                plain.triangle == kNoLayerHit ? kNoLayerHit : plain.triangle | (plain.along ? kAlongAxis : 0);
            differ += mixed.hit[k] != expected;
            if (mixed.hit[k] != expected || expected == kNoLayerHit) continue;
            vec3 const hit{mixed.hit_x[k], mixed.hit_y[k], mixed.hit_z[k]};
            EXPECT_LT(glm::length(hit - plain.position), 1e-5f);
        }
        EXPECT_LE(differ, n / 1000);
        EXPECT_LE(doubts_differ, n / 1000);
    }
}

/// @return shares of look-ups that are doubtful, and of the others those that rays do not confirm
std::pair<double, double> doubts(World const& world, std::uint32_t resolution, int threads)
{
    TriangleSoup const soup = make_soup(world);
    ExactVisibility const exact(world, false, threads);
    Pcg32 rng(5, 1);
    std::size_t doubtful = 0, wrong = 0, n = 0;
    for (int a = 0; a < 40; ++a) {
        vec3 const axis = glm::normalize(vec3{rng.uniform(), rng.uniform(), rng.uniform()} - 0.5f);
        HitBuffer const b =
            make_hit_buffer(soup, make_grid(world.bounds, axis, resolution, rng.uniform2(), 6 * rng.uniform()));
        AxisView const view_of{{view(b), {}}};
        for (int k = 0; k < 1000; ++k, ++n) {
            WalkOrigin const o = random_origin(world, axis, rng);
            LayerHit const found = nearest_layer(view_of, world.surfaces, o);
            if (is_doubtful(view_of, world.surfaces, o, found)) {
                ++doubtful;
                continue;
            }
            Surface const& s = world.surfaces[o.triangle];
            vec3 const way = o.up ? axis : -axis, normal = glm::normalize(glm::cross(s.edge1, s.edge2));
            RayQuery const ray{
                .ray = {o.position + (glm::dot(way, normal) > 0 ? s.clearance : -s.clearance) * normal, way}};
            Hit hit;
            exact.nearest({&ray, 1}, {&hit, 1});
            float const distance = glm::length(found.position - o.position);
            bool const same =
                hit.triangle == kNoTriangle || found.triangle == kNoLayerHit
                    ? (hit.triangle == kNoTriangle) == (found.triangle == kNoLayerHit)
                    : std::abs(hit.distance - distance) < 4 * view_of.grid().texel + 0.02f * distance;
            wrong += same ? 0 : 1;
        }
    }
    return {double(doubtful) / double(n), double(wrong) / double(n - doubtful)};
}

TEST(Query, WhatIsNotDoubtfulIsRight)
{
    Scene open;
    int const m = add_material(open, lambert(vec3{0.5f}));
    add_box(open, {-1, -1, -1}, {1, 1, 1}, m, true);
    add_box(open, {-40, -1.3f, -40}, {40, -1.2f, 40}, m, false);
    for (auto const& [world, resolution] : {std::pair(room_with_spheres(), 128u), {world_of(open), 1024u}}) {
        auto const [doubtful, wrong] = doubts(world, resolution, 1);
        std::cout << 100 * doubtful << " % doubtful, " << 100 * wrong << " % of the others wrong\n";
        EXPECT_LT(doubtful, 0.4);
        EXPECT_LT(wrong, 0.004);
    }
}

TEST(Query, PackedLayersAnswerNearlyTheSame)
{
    World const world = room_with_spheres();
    TriangleSoup const soup = make_soup(world);
    Pcg32 rng(7, 7);
    std::vector<HitBuffer> buffers;
    for (int a = 0; a < 3; ++a)
        buffers.push_back(make_hit_buffer(
            soup, make_grid(world.bounds, glm::normalize(vec3{1, float(a), 0.4f}), 64, {0.3f, 0.1f}, 1)));
    AxisPool exact, packed;
    fill_pool(buffers, exact);
    fill_pool(buffers, packed, true);
    EXPECT_LT(packed.bytes(), exact.bytes());
    QueryBatch a, b;
    a.resize(6000);
    b.resize(6000);
    for (std::size_t k = 0; k < a.size(); ++k) {
        WalkOrigin const o = random_origin(world, exact.grids[k % 3].axis, rng);
        a.set(k, o, std::uint32_t(k % 3));
        b.set(k, o, std::uint32_t(k % 3));
    }
    nearest_layers(exact, world.surfaces, a);
    nearest_layers(packed, world.surfaces, b);
    std::size_t differ = 0;
    float farthest = 0;
    for (std::size_t k = 0; k < a.size(); ++k) {
        differ += a.hit[k] != b.hit[k];
        if (a.hit[k] != b.hit[k] || a.hit[k] == kNoLayerHit) continue;
        farthest =
            std::max(farthest,
                     glm::length(vec3{a.hit_x[k] - b.hit_x[k], a.hit_y[k] - b.hit_y[k], a.hit_z[k] - b.hit_z[k]}));
    }
    EXPECT_LT(differ, a.size() / 100);
    EXPECT_LE(farthest, 7.0f / 4095); // half a step, of depths 7 m apart at most
}

TEST(Query, HitsLieOnTheirTriangles)
{
    World const world = room_with_spheres();
    TriangleSoup const soup = make_soup(world);
    Pcg32 rng(4, 4);
    vec3 const axis = glm::normalize(vec3{0.2f, 0.9f, -0.4f});
    HitBuffer const b = make_hit_buffer(soup, make_grid(world.bounds, axis, 64, {0.2f, 0.7f}, 0.5f));
    AxisView const view_of{{view(b), {}}};
    for (int k = 0; k < 5000; ++k) {
        LayerHit const hit = nearest_layer(view_of, world.surfaces, random_origin(world, axis, rng));
        if (hit.triangle == kNoLayerHit) continue;
        Surface const& s = world.surfaces[hit.triangle];
        vec3 const n = glm::normalize(glm::cross(s.edge1, s.edge2));
        float const slope = 1 / std::max(1e-3f, std::abs(glm::dot(n, axis)));
        EXPECT_NEAR(glm::dot(n, hit.position - s.corner) / slope, 0, 2e-5f);
    }
}

/// A pair of parts that are rasterised together or apart.
TEST(Query, TwoSegmentsAnswerAsOne)
{
    World const world = room_with_spheres();
    TriangleSoup const all = make_soup(world);
    std::size_t const walls = 13; // the room, and a triangle of a sphere
    vec3 const axis = glm::normalize(vec3{-0.4f, 0.3f, 0.7f});
    RasterGrid const grid = make_grid(world.bounds, axis, 48, {0.1f, 0.4f}, 2);
    HitBuffer const one = make_hit_buffer(all, grid);
    HitBuffer parts[2];
    for (int k = 0; k < 2; ++k) {
        Fragments f;
        rasterize(all, k == 0 ? 0 : walls, k == 0 ? walls : all.count, grid, MacroPath::edge_table, f);
        fill_hit_buffer(f, grid, 0, parts[k]);
    }
    AxisView const together{{view(one), {}}}, apart{{view(parts[0]), view(parts[1])}};
    Pcg32 rng(5, 5);
    std::size_t differ = 0;
    for (int k = 0; k < 4000; ++k) {
        WalkOrigin const o = random_origin(world, axis, rng);
        differ += nearest_layer(together, world.surfaces, o).triangle !=
                  nearest_layer(apart, world.surfaces, o).triangle;
    }
    EXPECT_LE(differ, 4u); // equal depths may come in another order
}

// --- The rule against self-intersection: what a walk must not hit, and what it must.

struct Rule {
    World world;
    TriangleSoup soup;

    explicit Rule(Scene scene) : world(world_of(std::move(scene))), soup(make_soup(world)) {}

    /// Share of walks from points of triangles first..last - 1, leaving upwards (+Y side), whose answer fulfils a
    /// condition; over many axes, grids and points.
    template <class Condition>
    double share(std::uint32_t first, std::uint32_t last, std::uint32_t resolution,
                 Condition const& condition) const
    {
        Pcg32 rng(6, 6);
        int good = 0, all = 0;
        for (int a = 0; a < 60; ++a) {
            vec3 const axis =
                glm::normalize(vec3{2 * rng.uniform() - 1, 0.05f + rng.uniform(), 2 * rng.uniform() - 1});
            HitBuffer const b = make_hit_buffer(
                soup, make_grid(world.bounds, axis, resolution, rng.uniform2(), 6 * rng.uniform()));
            AxisView const v{{view(b), {}}};
            for (int k = 0; k < 50; ++k) {
                std::uint32_t const t = first + rng.next() % (last - first);
                Surface const& s = world.surfaces[t];
                vec2 u = rng.uniform2();
                if (u.x + u.y > 1) u = 1.0f - u;
                vec3 const n = glm::normalize(glm::cross(s.edge1, s.edge2));
                float const cosine = glm::dot(n, axis), upwards = n.y > 0 ? cosine : -cosine;
                if (upwards < 0.02f) continue;
                WalkOrigin const o{s.corner + u.x * s.edge1 + u.y * s.edge2, t, cosine > 0, true,
                                   std::sqrt(1 - cosine * cosine) / std::abs(cosine)};
                good += condition(nearest_layer(v, world.surfaces, o), o);
                ++all;
            }
        }
        return double(good) / all;
    }
};

TEST(SelfIntersection, ThinWallOfATenthOfATexelHidesItsOtherSide)
{
    // Walks from the top of a slab never meet its bottom.
    Scene scene;
    int const m = add_material(scene, lambert(vec3{0.5f}));
    float const texel = 2.0f / 32;
    add_box(scene, {-1, -0.05f * texel, -1}, {1, 0.05f * texel, 1}, m, false);
    Rule const rule(std::move(scene));
    for (std::uint32_t t = 0; t < rule.world.triangles.size(); ++t) {
        Surface const& s = rule.world.surfaces[t];
        if (glm::cross(s.edge1, s.edge2).y <= 0 || s.corner.y < 0) continue;
        EXPECT_EQ(rule.share(t, t + 1, 32,
                             [](LayerHit const& h, WalkOrigin const&) { return h.triangle == kNoLayerHit; }),
                  1.0);
    }
}

TEST(SelfIntersection, CoplanarTwinsDoNotShadowEachOther)
{
    Scene scene;
    int const m = add_material(scene, lambert(vec3{0.5f}));
    add_quad(scene, {-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, m);
    add_quad(scene, {-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, m);
    add_quad(scene, {-1, 0, 1}, {0, 0, -2}, {2, 0, 0}, m); // and one that faces down
    Rule const rule(std::move(scene));
    EXPECT_EQ(rule.share(0, 6, 64, [](LayerHit const& h, WalkOrigin const&) { return h.triangle == kNoLayerHit; }),
              1.0);
}

TEST(SelfIntersection, ConvexMeshesDoNotShadowThemselves)
{
    Scene scene;
    add_sphere(scene, vec3{0}, 1, 4, add_material(scene, lambert(vec3{0.5f})), false);
    Rule const rule(std::move(scene));
    for (std::uint32_t const resolution : {8u, 32u, 128u}) {
        double const free = rule.share(0, std::uint32_t(rule.world.triangles.size()), resolution,
                                       [](LayerHit const& h, WalkOrigin const& o) {
                                           // From below the equator the way up leads through the sphere itself.
                                           return h.triangle == kNoLayerHit || o.position.y < 0.1f;
                                       });
        EXPECT_EQ(free, 1.0) << resolution;
    }
}

TEST(SelfIntersection, AContactIsNotALeak)
{
    // A box on the floor of a closed room: walks from the floor around it never leave the room.
    Scene scene;
    int const m = add_material(scene, lambert(vec3{0.5f}));
    add_box(scene, {-1, 0, -1}, {1, 2, 1}, m, true);
    add_box(scene, {-0.3f, 0, -0.3f}, {0.3f, 0.6f, 0.3f}, m, false);
    Rule const rule(std::move(scene));
    for (std::uint32_t t = 0; t < 12; ++t) {
        Surface const& s = rule.world.surfaces[t];
        if (glm::cross(s.edge1, s.edge2).y <= 0) continue; // the floor
        double const inside = rule.share(
            t, t + 1, 48, [](LayerHit const& h, WalkOrigin const&) { return h.triangle != kNoLayerHit; });
        EXPECT_GT(inside, 0.998);
    }
}

} // namespace
} // namespace gi::test
