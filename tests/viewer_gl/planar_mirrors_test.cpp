// Flat mirrors are found among curved ones, and each once.

#include "viewer/devices/gl/planar_mirrors.h"

#include "tests/support/scenes.h"

#include <gtest/gtest.h>

namespace viewer::test {
namespace {

TEST(PlanarMirrors, AreFoundBehindABallWithMoreFacesThanTheyMayBe)
{
    gi::Scene scene;
    int const mirror = gi::test::add_material(scene, gi::test::mirror(gi::vec3{0.9f}));
    gi::test::add_sphere(scene, {0, 0, 0}, 1, 3, mirror, true);
    gi::test::add_quad(scene, {-3, -2, -4}, {6, 0, 0}, {0, 4, 0}, mirror);
    gi::Report report;
    auto const world =
        std::make_shared<gi::MovingWorld>(std::make_shared<gi::Scene const>(std::move(scene)), 0.0, report);
    ASSERT_GT(world->world().triangles.size(), 200u);
    PlanarMirrors found;
    found.take(*gi::shown_scene(world, {}, nullptr));
    auto const wall = [](PlanarMirror const& m) { return std::abs(m.area_m2 - 24) < 1e-3f; };
    ASSERT_EQ(std::ranges::count_if(found.all(), wall), 1);
    EXPECT_GT(std::ranges::find_if(found.all(), wall)->normal.z, 0.999f);
}

} // namespace
} // namespace viewer::test
