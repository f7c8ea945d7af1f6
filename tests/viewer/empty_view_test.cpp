// Pictures in which nothing is to be seen.

#include "tests/support/scenes.h"
#include "viewer/offline/empty_view.h"

#include <gtest/gtest.h>

namespace viewer::test {
namespace {

using namespace gi::test;

/// What is reported of a square of `size_m` at (0, 0, -5), seen from the origin.
std::string seen(gi::dvec3 at, float size_m, int width = 320, int height = 200, bool orthographic = false)
{
    gi::Scene scene;
    add_quad(scene, {-size_m / 2, -size_m / 2, -5}, {size_m, 0, 0}, {0, size_m, 0},
             add_material(scene, lambert(gi::vec3{0.5f})));
    gi::World const world = world_of(scene);
    gi::Camera camera = gi::look_at({0, 0, 0}, at, 45);
    camera.orthographic = orthographic;
    gi::Report report;
    report_empty_view(world, camera, width, height, report);
    return report.losses().empty() ? "" : report.losses().begin()->first;
}

TEST(EmptyView, IsWhereTheCameraLooksElsewhere)
{
    EXPECT_EQ(seen({0, 0, -1}, 1), "");
    EXPECT_EQ(seen({0, 0, 1}, 1), kSeesNothing);
    EXPECT_EQ(seen({1, 0, 0.2}, 1), kSeesNothing);
    EXPECT_EQ(seen({0, 1, -0.2}, 1), kSeesNothing);
    EXPECT_EQ(seen({1, 0, -1}, 8), "") << "at the edge";
    EXPECT_EQ(seen({0, 0, -1}, 1e6f), "") << "all around";
    EXPECT_EQ(seen({0, 0, -1}, 1, 320, 200, true), "");
    EXPECT_EQ(seen({0, 0, -1}, 1, 1, 1), "") << "a picture of one pixel";
}

TEST(EmptyView, IsASpeckInOtherUnits)
{
    EXPECT_EQ(seen({0, 0, -1}, 0.01f), kSeesSpeck);
    EXPECT_EQ(seen({0, 0, -1}, 0.2f), "");
    EXPECT_EQ(seen({0, 0, -1}, 0.01f, 20, 10), "") << "all things are specks in a tiny picture";
}

TEST(EmptyView, OfASceneWithoutTriangles)
{
    gi::Report report;
    report_empty_view(world_of(gi::Scene{}), gi::look_at({0, 0, 0}, {0, 0, -1}, 45), 64, 64, report);
    EXPECT_TRUE(report.losses().contains(std::string(kSeesNothing)));
    gi::Scene sky;
    set_environment(sky, gi::vec3{1});
    gi::Report none;
    report_empty_view(world_of(sky), gi::look_at({0, 0, 0}, {0, 0, -1}, 45), 64, 64, none);
    EXPECT_TRUE(none.losses().empty()) << "a picture of the sky";
}

} // namespace
} // namespace viewer::test
