// Each triangle is drawn once, in a cluster of its material that encloses it; clusters are compact.

#include "viewer/devices/gl/surface_order.h"

#include "tests/support/scenes.h"

#include <gtest/gtest.h>
#include <numeric>

namespace viewer::test {
namespace {

TEST(SurfaceOrder, HasEachTriangleOnceNearOthersOfItsMaterial)
{
    gi::Scene scene;
    int const a = gi::test::add_material(scene, gi::test::lambert(gi::vec3{0.5f})),
              b = gi::test::add_material(scene, gi::test::mirror(gi::vec3{0.9f}));
    for (int k = 0; k < 4; ++k) {
        gi::test::add_sphere(scene, {10.0 * k, 0, 0}, 1, 4, k % 2 == 0 ? a : b, true);
        gi::test::add_quad(scene, {10.0f * float(k), -1, -1}, {2, 0, 0}, {0, 0, 2}, a);
    }
    gi::Report report;
    auto const world =
        std::make_shared<gi::MovingWorld>(std::make_shared<gi::Scene const>(std::move(scene)), 0.0, report);
    auto const shown = gi::shown_scene(world, {}, nullptr);
    gi::World const& w = world->world();
    SurfaceOrder const order = order_surfaces(*shown, false, {});

    auto const less = [](gi::uvec3 const& p, gi::uvec3 const& q) {
        return std::tuple(p.x, p.y, p.z) < std::tuple(q.x, q.y, q.z);
    };
    std::vector<gi::uvec3> drawn = order.triangles, all = w.triangles;
    std::ranges::sort(drawn, less);
    std::ranges::sort(all, less);
    EXPECT_EQ(drawn, all);

    std::uint32_t next = 0;
    for (SurfacePart const& part : order.parts) {
        EXPECT_EQ(part.triangles.first, next);
        for (SurfaceCluster const& c : part.clusters) {
            EXPECT_EQ(c.triangles.first, next);
            next += c.triangles.count;
            EXPECT_LT(glm::length(c.bounds.high - c.bounds.low), 25) << "all would be 32 m wide";
            for (std::uint32_t t = c.triangles.first; t < next; ++t)
                for (int k = 0; k < 3; ++k) {
                    gi::vec3 const p = w.positions[order.triangles[t][k]];
                    EXPECT_EQ(glm::clamp(p, c.bounds.low, c.bounds.high), p);
                }
        }
        EXPECT_EQ(part.triangles.first + part.triangles.count, next);
    }
    EXPECT_EQ(next, w.triangles.size());
    EXPECT_GT(std::accumulate(order.parts.begin(), order.parts.end(), std::size_t(0),
                              [](std::size_t n, SurfacePart const& p) { return n + p.clusters.size(); }),
              4u);
}

} // namespace
} // namespace viewer::test
