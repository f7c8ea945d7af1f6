#include "gi/bvh/build_kernels.h"
#include "gi/bvh/trace_rays.h"
#include "gi/core/rng.h"
#include "gi/kernel/launch.h"
#include "gi/kernel/sort.h"
#include "tests/support/closed_mesh.h"
#include "tests/support/on_device.h"
#include "tests/support/stop_at_ask.h"

#include <algorithm>
#include <cstring>
#include <gtest/gtest.h>
#include <limits>
#include <tbb/global_control.h>

namespace gi::test {
namespace {

struct Mesh {
    std::vector<vec3> positions;
    std::vector<uvec3> triangles;

    TriangleList list() const { return {positions, triangles, 0, std::uint32_t(triangles.size())}; }
    void add(vec3 a, vec3 b, vec3 c)
    {
        auto const n = std::uint32_t(positions.size());
        positions.insert(positions.end(), {a, b, c});
        triangles.push_back({n, n + 1, n + 2});
    }
};

vec3 random_point(Pcg32& rng) { return {rng.uniform(), rng.uniform(), rng.uniform()}; }

Mesh random_triangles(std::size_t n, float size, float scale, Pcg32& rng)
{
    Mesh m;
    for (std::size_t i = 0; i < n; ++i) {
        vec3 const at = random_point(rng);
        m.add(scale * at, scale * (at + size * (random_point(rng) - 0.5f)),
              scale * (at + size * (random_point(rng) - 0.5f)));
    }
    return m;
}

constexpr auto kAll = [](std::uint32_t, vec2) { return true; };

BvhHit by_brute_force(Mesh const& m, BvhRay const& ray, float reach)
{
    BvhHit hit;
    hit.distance = reach;
    for (std::uint32_t t = 0; t < m.triangles.size(); ++t) {
        if (triangle_box(m.list(), t).empty()) continue;
        uvec3 const v = m.triangles[t];
        TriangleHit const h = meet_triangle(m.positions[v.x] - ray.origin, m.positions[v.y] - ray.origin,
                                            m.positions[v.z] - ray.origin, ray.shear, ray.start, hit.distance);
        if (h.distance < hit.distance || (h.distance == hit.distance && h.distance < kInf && t < hit.triangle))
            hit = {t, h.distance, h.weights};
    }
    return hit;
}

/// Traversal finds what brute force finds, to the bit.
void expect_exact(Mesh const& m, HostBvh const& bvh, float scale, Pcg32& rng, int rays = 300)
{
    int met = 0;
    for (int i = 0; i < rays; ++i) {
        vec3 direction = random_direction(rng);
        if (i % 10 == 0) direction = vec3{i % 30 == 0, i % 30 == 10, i % 30 == 20}; // along an axis
        BvhRay const ray({scale * (2.0f * random_point(rng) - 0.5f), direction}, i % 7 == 0 ? 0.1f * scale : 0);
        float const reach = i % 3 == 0 ? 0.5f * scale : 1e30f;
        BvhHit const truth = by_brute_force(m, ray, reach);
        met += truth.triangle != kNoBvhTriangle;
        BvhHit nearest, any;
        nearest.distance = any.distance = reach;
        trace_scalar<false>(bvh.view(), ray, nearest, kAll);
        trace_scalar<true>(bvh.view(), ray, any, kAll);
        ASSERT_EQ(nearest.triangle, truth.triangle) << i;
        ASSERT_EQ(nearest.distance, truth.distance) << i;
        ASSERT_EQ(nearest.weights, truth.weights) << i;
        ASSERT_EQ(any.triangle == kNoBvhTriangle, truth.triangle == kNoBvhTriangle);
    }
    bool const usable = std::ranges::any_of(m.positions, [](vec3 p) { return all_finite(p); });
    if (m.triangles.size() >= 300 && usable) {
        EXPECT_GT(met, 0);
    }
}

/// Every triangle is in one leaf, and every box holds what is below it.
void expect_sound(HostBvh const& bvh, Mesh const& m)
{
    std::vector<int> seen(m.triangles.size());
    for (WideNode const& node : bvh.nodes.view())
        for (std::uint32_t k = 0; k < node.children; ++k) {
            Box box;
            if (node.is_leaf(k)) {
                for (std::uint32_t const t : bvh.leaves.view()[node.child(k)].triangle)
                    if (t != kNoLeafTriangle) {
                        ++seen[t];
                        box = joined(box, triangle_box(m.list(), t));
                    }
            } else {
                box = bvh.boxes.view()[node.child(k)];
            }
            if (box.empty()) continue;
            for (int axis = 0; axis < 3; ++axis) {
                auto const plane = [&](std::uint8_t byte) {
                    return double(node.corner[axis]) + double(byte) * double(node.step(axis));
                };
                ASSERT_LT(plane(node.low[axis][k]), double(box.low[axis]));
                ASSERT_GT(plane(node.high[axis][k]), double(box.high[axis]));
            }
        }
    for (int const n : seen) ASSERT_EQ(n, 1);
    EXPECT_LE(bvh.level.size(), kDeepest);
}

TEST(Bvh, FindsWhatBruteForceFinds)
{
    Pcg32 rng(1, 1);
    for (std::size_t const n : {1u, 2u, 3u, 4u, 5u, 8u, 9u, 33u, 1000u})
        for (float const scale : {1.0f, 1e-6f, 1e6f, 1e12f}) {
            Mesh const m = random_triangles(n, 0.3f, scale, rng);
            HostBvh const bvh = build_bvh<Space::host>(m.list());
            expect_sound(bvh, m);
            expect_exact(m, bvh, scale, rng);
        }
}

TEST(Bvh, OfNothingIsNeverHit)
{
    HostBvh const bvh = build_bvh<Space::host>({});
    BvhHit hit;
    trace_scalar<false>(bvh.view(), BvhRay({vec3{0}, vec3{0, 0, 1}}, 0), hit, kAll);
    EXPECT_EQ(hit.triangle, kNoBvhTriangle);
}

/// Triangles without area, not finite or too far away are never hit and disturb no other.
TEST(Bvh, HoldsUnusableTriangles)
{
    Pcg32 rng(2, 1);
    float const nan = std::numeric_limits<float>::quiet_NaN();
    Mesh m = random_triangles(500, 0.2f, 1, rng);
    for (std::size_t i = 0; i < m.positions.size(); i += 7)
        m.positions[i] = i % 4 == 0   ? vec3{nan}
                         : i % 4 == 1 ? vec3{0, 1e19f, 0}
                         : i % 4 == 2 ? vec3{1e30f}
                                      : vec3{kInf};
    for (std::size_t i = 0; i + 2 < m.positions.size(); i += 21) m.positions[i + 1] = m.positions[i + 2];
    HostBvh const bvh = build_bvh<Space::host>(m.list());
    expect_sound(bvh, m);
    expect_exact(m, bvh, 1, rng);
    for (vec3& p : m.positions) p = vec3{nan};
    HostBvh none = build_bvh<Space::host>(m.list());
    expect_exact(m, none, 1, rng);
}

/// Sizes of 1e-15 to 1e17 m in one tree (products of smaller ones are not floats),
/// and a room of 1 m far from its origin.
TEST(Bvh, SpansAllSizes)
{
    Pcg32 rng(3, 1);
    Mesh m;
    for (int e = -15; e <= 17; ++e) {
        float const s = std::pow(10.0f, float(e));
        m.add({s, 0, 0}, {0, s, 0}, {0, 0, s});
        m.add({-s, 0, 0}, {0, -s, 0}, {0, 0, -s});
    }
    HostBvh const bvh = build_bvh<Space::host>(m.list());
    expect_sound(bvh, m);
    for (float const scale : {1e-12f, 1.0f, 1e15f}) expect_exact(m, bvh, scale, rng);
    Mesh far = random_triangles(300, 0.3f, 1, rng);
    for (vec3& p : far.positions) p += vec3{1e5f, 0, -1e5f};
    HostBvh const there = build_bvh<Space::host>(far.list());
    expect_sound(there, far);
    for (int i = 0; i < 300; ++i) {
        BvhRay const ray({vec3{1e5f, 0, -1e5f} + 2.0f * random_point(rng), random_direction(rng)}, 0);
        BvhHit hit;
        hit.distance = 1e30f;
        trace_scalar<false>(there.view(), ray, hit, kAll);
        EXPECT_EQ(hit.triangle, by_brute_force(far, ray, 1e30f).triangle);
    }
}

/// Equal triangles, and sizes that halve: trees that clustering alone would make deep or slow.
TEST(Bvh, IsNeverTooDeep)
{
    Mesh equal;
    for (int i = 0; i < 20000; ++i) equal.add({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    expect_sound(build_bvh<Space::host>(equal.list()), equal);
    Mesh halving;
    for (int i = 0; i < 120; ++i)
        for (int k = 0; k < 40; ++k) {
            float const s = std::ldexp(1.0f, -i);
            halving.add({s, 0, 0}, {s, s, 0}, {s, 0, s});
        }
    expect_sound(build_bvh<Space::host>(halving.list()), halving);
    Mesh line;
    for (int i = 0; i < 5000; ++i) line.add({float(i) * float(i), 0, 0}, {float(i) * float(i), 1, 0}, {0, 0, 1});
    expect_sound(build_bvh<Space::host>(line.list()), line);
}

/// Rays from inside through vertices and edges of a closed mesh all hit it.
TEST(Bvh, IsWatertight)
{
    Pcg32 rng(4, 1);
    World const world = random_closed_mesh(rng, 4, 0.2f);
    HostBvh const bvh =
        build_bvh<Space::host>({world.positions, world.triangles, 0, std::uint32_t(world.triangles.size())});
    std::size_t escaped = 0, rays = 0;
    auto const shoot = [&](vec3 at) {
        BvhHit hit;
        hit.distance = 1e30f;
        trace_scalar<false>(bvh.view(), BvhRay({vec3{0}, glm::normalize(at)}, 0), hit, kAll);
        escaped += hit.triangle == kNoBvhTriangle;
        ++rays;
    };
    for (uvec3 const t : world.triangles) {
        vec3 const a = world.positions[t.x], b = world.positions[t.y];
        shoot(a);
        for (int k = 0; k < 4; ++k) shoot(glm::mix(a, b, rng.uniform()));
    }
    EXPECT_GT(rays, 1000u);
    EXPECT_EQ(escaped, 0u);
}

TEST(Bvh, RefitsToAnyPlace)
{
    Pcg32 rng(5, 1);
    Mesh m = random_triangles(700, 0.2f, 1, rng);
    HostBvh bvh = build_bvh<Space::host>(m.list());
    for (int step = 0; step < 4; ++step) {
        for (vec3& p : m.positions) p += 0.2f * (random_point(rng) - 0.5f);
        if (step == 1) m.positions[9] = m.positions[300] = vec3{std::numeric_limits<float>::quiet_NaN()};
        if (step == 2) m.positions[9] = m.positions[300] = vec3{0.5f};
        refit(bvh, m.list());
        expect_sound(bvh, m);
        expect_exact(m, bvh, 1, rng);
    }
}

TEST(Bvh, IsTheSameForAnyNumberOfThreads)
{
    Pcg32 rng(6, 1);
    Mesh const m = random_triangles(30000, 0.02f, 1, rng);
    auto const bytes = [&](std::size_t threads) {
        tbb::global_control const control(tbb::global_control::max_allowed_parallelism, threads);
        HostBvh const bvh = build_bvh<Space::host>(m.list());
        auto const* const nodes = reinterpret_cast<char const*>(bvh.nodes.view().data);
        auto const* const leaves = reinterpret_cast<char const*>(bvh.leaves.view().data);
        return std::string(nodes, bvh.nodes.size() * sizeof(WideNode)) +
               std::string(leaves, bvh.leaves.size() * sizeof(Leaf));
    };
    EXPECT_TRUE(bytes(1) == bytes(4));
}

TEST(Bvh, BuildsAreInterrupted)
{
    Pcg32 rng(7, 1);
    Mesh const m = random_triangles(50000, 0.01f, 1, rng);
    StopAtAsk never;
    build_bvh<Space::host>(m.list(), &never);
    ASSERT_GE(never.asks(), 10u);
    for (std::uint64_t const ask : {std::uint64_t(1), never.asks() / 2, never.asks()}) {
        StopAtAsk stop(ask);
        EXPECT_THROW(build_bvh<Space::host>(m.list(), &stop), Interrupted) << ask;
        EXPECT_LE(stop.asks(), ask + asks_until_noticed());
    }
}

/// Trees built, refitted and traversed in either space find what brute force finds.
template <Space S>
void traces_rays()
{
    Pcg32 rng(9, 1);
    Mesh m = random_triangles(2000, 0.2f, 1, rng);
    Buffer<uvec3, S> const triangles = upload<S>(m.triangles);
    Buffer<vec3, S> const before = upload<S>(m.positions);
    auto const n = std::uint32_t(m.triangles.size());
    Bvh<S> still = build_bvh<S>({before.view(), triangles.view(), 0, n / 2}),
           moving = build_bvh<S>({before.view(), triangles.view(), n / 2, n});
    for (std::size_t i = 3 * n / 2; i < m.positions.size(); ++i)
        m.positions[i] += 0.1f * (random_point(rng) - 0.5f);
    Buffer<vec3, S> const after = upload<S>(m.positions);
    refit(moving, {after.view(), triangles.view(), n / 2, n});
    std::vector<BvhQuery> queries(3000);
    for (BvhQuery& q : queries) q = {{2.0f * random_point(rng) - 0.5f, random_direction(rng)}, 0, 1e30f};
    Buffer<BvhQuery, S> const asked = upload<S>(queries);
    Buffer<BvhHit, S> nearest(queries.size()), any(queries.size());
    launch(S, "nearest triangles", queries.size(),
           TraceRays<false>{asked.view(), {still.view(), moving.view()}, nearest.view()});
    launch(S, "any triangles", queries.size(),
           TraceRays<true>{asked.view(), {still.view(), moving.view()}, any.view()});
    std::vector<BvhHit> const hits = download(nearest), some = download(any);
    for (std::size_t i = 0; i < queries.size(); ++i) {
        BvhHit const truth = by_brute_force(m, BvhRay(queries[i].ray, 0), 1e30f);
        ASSERT_EQ(hits[i].triangle, truth.triangle);
        ASSERT_EQ(some[i].triangle == kNoBvhTriangle, truth.triangle == kNoBvhTriangle);
    }
}
LIGHTWELL_TEST_BOTH(BvhRays, FindWhatBruteForceFinds, traces_rays);

/// The tree of either space is the same, bit by bit, built and refitted.
template <Space S>
void builds_the_same()
{
    auto const same = [](auto const& here, auto const& there) {
        return here.size() == there.size() &&
               std::memcmp(here.data(), there.data(), here.size() * sizeof(here[0])) == 0;
    };
    Pcg32 rng(10, 1);
    Mesh const m = random_triangles(5000, 0.2f, 1, rng);
    HostBvh const expected = build_bvh<Space::host>(m.list());
    Buffer<uvec3, S> const triangles = upload<S>(m.triangles);
    Buffer<vec3, S> const positions = upload<S>(m.positions);
    TriangleList const list{positions.view(), triangles.view(), 0, std::uint32_t(m.triangles.size())};
    Bvh<S> found = build_bvh<S>(list);
    for (int k = 0; k < 2; ++k) {
        EXPECT_TRUE(same(download(expected.nodes), download(found.nodes)));
        EXPECT_TRUE(same(download(expected.leaves), download(found.leaves)));
        EXPECT_TRUE(same(download(expected.boxes), download(found.boxes)));
        refit(found, list);
    }
}
LIGHTWELL_TEST_BOTH(BvhTree, IsTheSameInBothSpaces, builds_the_same);

template <Space S>
void sorts_pairs()
{
    Pcg32 rng(8, 1);
    for (std::size_t const n : {0u, 1u, 2u, 1000u, 70000u}) {
        std::vector<std::uint64_t> keys(n);
        std::vector<std::uint32_t> values(n);
        for (std::size_t i = 0; i < n; ++i) {
            keys[i] = i % 3 == 0 ? rng.next() % 5 : std::uint64_t(rng.next()) << 32 | rng.next();
            values[i] = std::uint32_t(i);
        }
        std::vector<std::uint32_t> expected = values;
        std::ranges::stable_sort(expected, [&](std::uint32_t a, std::uint32_t b) { return keys[a] < keys[b]; });
        Buffer<std::uint64_t, S> k = upload<S>(keys), scratch_keys(n);
        Buffer<std::uint32_t, S> v = upload<S>(values), scratch(n);
        sort_pairs(S, k.view(), v.view(), scratch_keys.view(), scratch.view());
        EXPECT_EQ(download(v), expected);
        std::ranges::sort(keys);
        EXPECT_EQ(download(k), keys);
    }
}
LIGHTWELL_TEST_BOTH(SortPairs, IsStable, sorts_pairs);

} // namespace
} // namespace gi::test
