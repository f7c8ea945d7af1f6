// Flat mirrors are found among curved ones, and each once.

#include "gi/surfaces/planar_mirrors.h"

#include "tests/support/scenes.h"

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

namespace gi::test {
namespace {

std::shared_ptr<ShownScene const> shown(Scene scene)
{
    Report report;
    return shown_scene(std::make_shared<MovingWorld>(std::make_shared<Scene const>(std::move(scene)), 0.0, report),
                       {}, nullptr);
}

/// Of a camera at the origin that looks along a direction.
CameraRays rays(dvec3 direction)
{
    Camera camera;
    camera.world_from_camera = glm::inverse(glm::lookAt(dvec3(0), direction, dvec3(0, 1, 0)));
    camera.yfov_rad = 0.8f;
    return camera_rays(camera, 40, 40, dvec3(0));
}

TEST(PlanarMirrors, AreFoundBehindABallWithMoreFacesThanTheyMayBe)
{
    Scene scene;
    int const silver = add_material(scene, mirror(vec3{0.9f}));
    add_sphere(scene, {0, 0, 0}, 1, 3, silver, true);
    add_quad(scene, {-3, -2, -4}, {6, 0, 0}, {0, 4, 0}, silver);
    auto const all = shown(std::move(scene));
    ASSERT_GT(all->world->triangles.size(), 200u);
    PlanarMirrors found;
    found.take(*all);
    auto const wall = [](PlanarMirror const& m) { return std::abs(m.area_m2 - 24) < 1e-3f; };
    ASSERT_EQ(std::ranges::count_if(found.all(), wall), 1);
    EXPECT_GT(std::ranges::find_if(found.all(), wall)->normal.z, 0.999f);
}

TEST(PlanarMirrors, LeaveOutBallsPanesAndTheThirdOne)
{
    Scene scene;
    int const silver = add_material(scene, mirror(vec3{0.9f})), pane = add_material(scene, glass(1.5f, true));
    add_quad(scene, {-1, -1, -4}, {2, 0, 0}, {0, 2, 0}, silver); // before
    add_sphere(scene, {0, 0, 4}, 1, 3, silver, true);            // behind
    add_quad(scene, {4, -1, -1}, {0, 0, 2}, {0, 2, 0}, pane);    // to the right
    for (int k = 0; k < 3; ++k)                                  // to the left
        add_quad(scene, {-4 - 0.1f * float(k), -1, float(k - 1)}, {0, 0, 0.7f}, {0, 2, 0}, silver);
    PlanarMirrors found;
    found.take(*shown(std::move(scene)));
    EXPECT_TRUE(found.left_out(rays({0, 0, -1}), 40, 40).empty());
    PixelBox const ball = found.left_out(rays({0, 0, 1}), 40, 40);
    EXPECT_GT(ball.low.x, 0);
    EXPECT_LE(ball.low.x, 7); // its box begins 0.33 from the middle of a picture that is 0.42 wide on each side
    EXPECT_EQ(ball.low, 40 - ball.high);
    EXPECT_FALSE(found.left_out(rays({1, 0, 0}), 40, 40).empty());
    EXPECT_FALSE(found.left_out(rays({-1, 0, 0}), 40, 40).empty());
    EXPECT_TRUE(found.left_out(rays({0, 1, 1e-3}), 40, 40).empty());
}

/// Two doors in one plane are two mirrors; a bent one is none, and one that is still a point may become one.
TEST(PlanarMirrors, MayMoveApartBendAndGrow)
{
    Scene scene;
    int const silver = add_material(scene, mirror(vec3{0.9f}));
    add_quad(scene, {-2, -1, -4}, {1.9f, 0, 0}, {0, 2, 0}, silver);
    add_quad(scene, {0.1f, -1, -4}, {1.9f, 0, 0}, {0, 2, 0}, silver);
    for (Node& n : scene.nodes) n.driven = true;
    Scene with_point = scene;
    auto const doors = shown(std::move(scene));
    PlanarMirrors found;
    found.take(*doors);
    EXPECT_EQ(found.all().size(), 2u);
    CameraRays const camera = rays({0, 0, -1});
    EXPECT_TRUE(found.left_out(camera, 40, 40).empty());
    ShownScene::Moved now = *doors->moved;
    std::size_t const half = now.positions.size() / 2;
    for (std::size_t k = 0; k < half; ++k) now.positions[k].z -= 1; // one slides back
    found.move(now);
    EXPECT_TRUE(found.left_out(camera, 40, 40).empty());
    now.positions[0].z -= 0.5f;
    found.move(now);
    EXPECT_FALSE(found.left_out(camera, 40, 40).empty());
    found.move(*doors->moved);
    EXPECT_TRUE(found.left_out(camera, 40, 40).empty());

    add_quad(with_point, {0, 0, 4}, {1, 0, 0}, {0, 1, 0}, silver);
    with_point.nodes.back().driven = true;
    with_point.nodes.back().scale = dvec3(0);
    found.take(*shown(std::move(with_point)));
    EXPECT_FALSE(found.left_out(camera, 40, 40).empty());
}

} // namespace
} // namespace gi::test
