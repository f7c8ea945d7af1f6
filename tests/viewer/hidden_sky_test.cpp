// Which mesh lies before the sky.

#include "tests/support/scenes.h"
#include "viewer/offline/hidden_sky.h"

#include <gtest/gtest.h>

namespace viewer::test {
namespace {

using namespace gi::test;
using Names = std::vector<std::string>;

/// A table on a floor; `dome_m` 0: without a dome.
gi::World world_under(float dome_m)
{
    gi::Scene scene;
    int const grey = add_material(scene, lambert(gi::vec3{0.5f}));
    auto const name = [&](char const* called) { scene.nodes.back().name = called; };
    add_quad(scene, {-2, 0, 2}, {4, 0, 0}, {0, 0, -4}, grey);
    name("Floor");
    add_box(scene, {-0.5f, 0, -0.5f}, {0.5f, 0.8f, 0.5f}, grey, false);
    if (dome_m > 0) {
        add_sphere(scene, {0, 0, 0}, dome_m, 2, grey, true);
        name("Dome");
    }
    set_environment(scene, gi::vec3{1});
    return world_of(scene);
}

TEST(HiddenSky, IsBehindTheMeshAroundTheCamera)
{
    for (float const dome_m : {5.0f, 1e4f}) {
        gi::World const world = world_under(dome_m);
        EXPECT_EQ(meshes_before_sky(world, gi::vec3(gi::dvec3{1, 1.5, 1} - world.origin)), Names{"Dome"});
        EXPECT_EQ(meshes_before_sky(world, gi::vec3{0, 3 * dome_m, 0}), Names()); // from outside
    }
    EXPECT_EQ(meshes_before_sky(world_under(0), {1, 1.5f, 1}), Names());
    EXPECT_EQ(meshes_before_sky(gi::World{}, {0, 0, 0}), Names());
}

} // namespace
} // namespace viewer::test
