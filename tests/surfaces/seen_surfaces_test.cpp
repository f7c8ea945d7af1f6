// The surfaces of a picture are those that exact rays meet; mirrors and panes show what
// is seen in them, where it seems to be.

#include "tests/surfaces/seen_picture.h"

#include <glm/gtc/matrix_transform.hpp>

namespace gi::test {
namespace {

/// A room of scale m with a turned block; no light.
Scene room(float scale, dvec3 at = dvec3{0})
{
    Scene scene;
    int const wall = add_material(scene, lambert({0.6f, 0.5f, 0.4f})),
              block = add_material(scene, lambert({0.1f, 0.3f, 0.8f}));
    add_box(scene, vec3{-scale}, vec3{scale}, wall, true);
    add_box(scene, scale * vec3{-0.4f, -1, -0.4f}, scale * vec3{0.3f, 0, 0.2f}, block, false);
    for (std::size_t k = scene.nodes.size() - 6; k < scene.nodes.size(); ++k)
        scene.nodes[k].rotation = glm::angleAxis(0.6, dvec3{0, 1, 0});
    for (Node& n : scene.nodes) n.translation = at;
    return scene;
}

Camera eye_in(double scale, dvec3 at = dvec3{0})
{
    return look_at(at + scale * dvec3{-0.6, 0.3, 0.9}, at + scale * dvec3{0.1, -0.4, 0}, 70);
}

/// @return share of the pixels that show what an exact ray does
double share_as_by_rays(World const& world, Camera const& camera, int width, int height)
{
    SeenPicture const seen = look(world, camera, width, height);
    CameraRays const rays = camera_rays(camera, width, height, world.origin);
    ExactVisibility const exact(world, false, 0);
    WorldView const w = view(world);
    float const size = world.bounds.radius();
    std::size_t same = 0;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            RayQuery const query{.ray = rays.through({float(x) + 0.5f, float(y) + 0.5f})};
            Hit hit;
            exact.nearest({&query, 1}, {&hit, 1});
            SeenSurface const& s = seen.at(x, y);
            EXPECT_TRUE(all_finite(s)) << x << ", " << y;
            if (hit.triangle == kNoTriangle) {
                same += s.depth == 0;
                continue;
            }
            ShadingPoint const at = shading_point(w, hit.triangle, hit.barycentric, query.ray.direction);
            float const depth = glm::dot(at.position - rays.origin, rays.forward);
            same += glm::length(s.position - at.position) < 1e-4f * size &&
                    std::abs(s.depth - depth) < 1e-4f * size && glm::dot(s.normal, at.frame.normal) > 0.9999f &&
                    glm::length(s.albedo - albedo(at.bsdf)) < 1e-6f && s.direct == vec3{0} && !s.in_mirror;
        }
    return double(same) / (width * height);
}

TEST(SeenSurfaces, AreThoseThatExactRaysMeet)
{
    EXPECT_GT(share_as_by_rays(world_of(room(1)), eye_in(1), 160, 120), 0.999);
}

TEST(SeenSurfaces, OfTinyHugeAndFarScenes)
{
    for (float const scale : {1e-3f, 1e5f})
        EXPECT_GT(share_as_by_rays(world_of(room(scale)), eye_in(double(scale)), 80, 60), 0.998) << scale;
    dvec3 const far{3e6, -2e5, 7e6};
    EXPECT_GT(share_as_by_rays(world_of(room(1, far)), eye_in(1, far), 80, 60), 0.998);
}

TEST(SeenSurfaces, ASmoothBallHasItsShadingNormals)
{
    Scene scene;
    add_sphere(scene, vec3{0}, 1, 4, add_material(scene, lambert(vec3{0.5f})), true);
    EXPECT_GT(share_as_by_rays(world_of(scene), look_at({0, 0.5, 3}, {0, 0, 0}, 50), 80, 60), 0.99);
}

TEST(SeenSurfaces, AnEmptySceneShowsItsSurroundings)
{
    Scene scene;
    set_environment(scene, {0.25f, 0.5f, 1});
    int const material = add_material(scene, lambert(vec3{0.5f}));
    add_quad(scene, {0, 0, 100}, {1, 0, 0}, {0, 1, 0}, material); // behind the camera
    SeenPicture const seen = look(world_of(scene), look_at({0, 0, 0}, {0, 0, -1}, 60), 16, 8);
    for (SeenSurface const& s : seen.pixels) {
        EXPECT_EQ(s.depth, 0);
        expect_near(s.emitted, {0.25f, 0.5f, 1}, 1e-3f, "environment");
        EXPECT_EQ(s.albedo, vec3{0});
    }
    SeenPicture const none =
        look(world_of(Scene{}), look_at({0, 0, 0}, {0, 0, -1}, 60), 16, 8, SeenSurfaces::Lights::few);
    for (SeenSurface const& s : none.pixels) EXPECT_TRUE(s.depth == 0 && s.emitted == vec3{0});
}

TEST(SeenSurfaces, ACameraInsideOfGeometryAndDegenerateTrianglesGiveNumbers)
{
    Scene scene = room(1);
    int const odd = add_material(scene, mirror(vec3{0.9f}));
    add_quad(scene, {0.1f, 0.2f, 0.3f}, vec3{0}, vec3{0}, odd);
    add_quad(scene, {0.1f, 0.2f, 0.3f}, {1, 0, 0}, {1, 0, 0}, odd);
    add_quad(scene, {-0.5f, 0.5f, -0.5f}, {1e-20f, 0, 0}, {0, 1e-20f, 0}, odd);
    add_light(scene, {.position = {0.5f, 0.5f, 0.5f}});
    World const world = world_of(scene);
    for (dvec3 const from : {dvec3{-0.05, -0.5, -0.1}, dvec3{0.1, 0.2, 0.3}, dvec3{0, -1, 0}, dvec3{0, 0.5, 0}})
        for (SeenSurface const& s :
             look(world, look_at(from, {0.3, -0.7, 0.2}, 90), 40, 30, SeenSurfaces::Lights::few).pixels)
            ASSERT_TRUE(all_finite(s)) << from.x << ", " << from.y;
}

TEST(SeenSurfaces, HolesAreSeenThrough)
{
    Scene scene;
    Material holed = lambert({0.9f, 0, 0});
    holed.alpha_mode = AlphaMode::mask;
    holed.alpha = 0.4f; // below the cut-off: all hole
    Material solid = holed;
    solid.alpha = 0.6f;
    add_quad(scene, {-2, -2, -3}, {4, 0, 0}, {0, 4, 0}, add_material(scene, lambert({0, 0.9f, 0})));
    add_quad(scene, {-2, -2, -2}, {2, 0, 0}, {0, 4, 0}, add_material(scene, holed));
    add_quad(scene, {0, -2, -2}, {2, 0, 0}, {0, 4, 0}, add_material(scene, solid));
    SeenPicture const seen = look(world_of(scene), look_at({0, 0, 0}, {0, 0, -1}, 40), 40, 30);
    EXPECT_NEAR(seen.at(10, 15).depth, 3, 1e-5f);
    EXPECT_NEAR(seen.at(10, 15).albedo.y, 0.9f, 1e-6f);
    EXPECT_NEAR(seen.at(30, 15).depth, 2, 1e-5f);
    EXPECT_NEAR(seen.at(30, 15).albedo.x, 0.9f, 1e-6f);
}

TEST(SeenSurfaces, HolesOfVerticesAreSeenThrough)
{
    Scene scene;
    Material red = lambert({0.9f, 0, 0});
    red.alpha_mode = AlphaMode::mask;
    add_quad(scene, {-2, -2, -3}, {4, 0, 0}, {0, 4, 0}, add_material(scene, lambert({0, 0.9f, 0})));
    add_quad(scene, {-2, -2, -2}, {4, 0, 0}, {0, 4, 0}, add_material(scene, red));
    scene.meshes.back().alphas = {0, 1, 1, 0}; // half in the middle
    SeenPicture const seen = look(world_of(scene), look_at({0, 0, 0}, {0, 0, -1}, 40), 40, 30);
    EXPECT_NEAR(seen.at(10, 15).depth, 3, 1e-5f);
    EXPECT_NEAR(seen.at(18, 5).depth, 3, 1e-5f);
    EXPECT_NEAR(seen.at(22, 5).depth, 2, 1e-5f);
    EXPECT_NEAR(seen.at(30, 15).depth, 2, 1e-5f);
}

/// The eye at the origin looks along -Z at a mirror at z = -2, and sees a wall at z = 1 behind itself. Its image
/// is at z = -5, and faces the eye.
TEST(SeenSurfaces, AMirrorShowsTheImageBehindIt)
{
    Scene scene;
    add_quad(scene, {-3, -3, -2}, {6, 0, 0}, {0, 6, 0}, add_material(scene, mirror({0.9f, 0.8f, 0.7f})));
    add_quad(scene, {-9, -9, 1}, {0, 18, 0}, {18, 0, 0}, add_material(scene, lambert({0.5f, 0.25f, 0.125f})));
    World const world = world_of(scene);
    Camera const camera = look_at({0, 0, 0}, {0, 0, -1}, 60);
    SeenPicture const seen = look(world, camera, 40, 30);
    CameraRays const rays = camera_rays(camera, 40, 30, world.origin);
    EXPECT_TRUE(SeenSurfaces::mirrors_in(world));
    for (auto const& [x, y] : {std::pair{20, 15}, {3, 4}, {37, 20}}) {
        SeenSurface const& s = seen.at(x, y);
        EXPECT_TRUE(s.in_mirror && s.is_image);
        vec3 const d = rays.through({float(x) + 0.5f, float(y) + 0.5f}).direction;
        expect_near(s.position + vec3(world.origin), d * (5 / -d.z), 1e-3f, "image");
        expect_near(s.normal, {0, 0, 1}, 1e-5f, "normal"); // the wall's is (0, 0, -1)
        EXPECT_NEAR(s.depth, 5, 1e-3f);
        float const away = std::pow(1 + d.z, 5.0f); // Schlick's rise to white
        for (int c = 0; c < 3; ++c) {
            float const f0 = 0.9f - 0.1f * float(c);
            EXPECT_NEAR(s.albedo[c], 0.5f / float(1 << c) * (f0 + (1 - f0) * away), 1e-4f) << c;
        }
    }
}

TEST(SeenSurfaces, KnowWhereNoMirrorIsSeen)
{
    Scene scene = room(1);
    add_quad(scene, {-0.5f, -0.5f, -0.9f}, {1, 0, 0}, {0, 1, 0}, add_material(scene, mirror(vec3{0.9f})));
    World const world = world_of(scene);
    SeenSurfaces const seen(world, 1);
    for (double const degrees : {0.0, 60.0, 85.0, 120.0, 180.0, 240.0, 275.0, 300.0}) {
        double const a = glm::radians(degrees);
        Camera const camera = look_at({0, 0.3, 0}, {std::sin(a), 0.3, -std::cos(a)}, 70);
        SeenPicture const picture = look(world, camera, 32, 32);
        bool shows = false;
        for (int i = 0; i < 32 * 32; ++i) shows |= picture.at(i % 32, i / 32).in_mirror;
        EXPECT_EQ(seen.may_show_mirrors(camera_rays(camera, 32, 32, world.origin), 32, 32), shows) << degrees;
    }
}

/// Two mirrors at a right angle show what is behind the eye turned by half a turn.
TEST(SeenSurfaces, TwoMirrorsTurnTheImage)
{
    Scene scene;
    int const m = add_material(scene, mirror(vec3{1}));
    add_quad(scene, {-4, -4, -4}, {4, 0, 4}, {0, 8, 0}, m);
    add_quad(scene, {0, -4, 0}, {4, 0, -4}, {0, 8, 0}, m);
    // The edge is at the origin and the mirrors open towards -Z; the eye is at z = -3 and looks along +Z.
    add_quad(scene, {-9, -9, -5}, {18, 0, 0}, {0, 18, 0}, add_material(scene, lambert({0.2f, 0.4f, 0.6f})));
    World const world = world_of(scene);
    Camera const camera = look_at({0.5, 0, -3}, {0.5, 0, 0}, 20);
    CameraRays const rays = camera_rays(camera, 21, 21, world.origin);
    SeenPicture const seen = look(world, camera, 21, 21);
    for (auto const& [x, y] : {std::pair{10, 10}, {8, 4}}) {
        SeenSurface const& s = seen.at(x, y);
        ASSERT_TRUE(s.in_mirror);
        vec3 const d = rays.through({float(x) + 0.5f, float(y) + 0.5f}).direction;
        // Turned by half a turn about the edge, the wall at z = -5 is at z = 5 and faces -Z.
        vec3 const from = rays.origin + vec3(world.origin);
        expect_near(s.position + vec3(world.origin), from + d * ((5 - from.z) / d.z), 2e-3f, "image");
        expect_near(s.normal, {0, 0, -1}, 1e-4f, "normal");
        expect_near(s.albedo, {0.2f, 0.4f, 0.6f}, 1e-3f, "albedo");
    }
}

/// Through the middle of a ball of glass the way is straight; a thin pane leaves everything where it is.
TEST(SeenSurfaces, GlassShowsWhatIsBehind)
{
    Scene scene;
    add_sphere(scene, {0, 0, -2}, 0.5f, 4, add_material(scene, glass(1.5f, false)), true);
    add_quad(scene, {0.8f, -2, -2}, {4, 0, 0}, {0, 4, 0}, add_material(scene, glass(1.5f, true)));
    add_quad(scene, {-9, -9, -4}, {18, 0, 0}, {0, 18, 0}, add_material(scene, lambert({0, 0, 0.8f})));
    World const world = world_of(scene);
    Camera const camera = look_at({0, 0, 0}, {0, 0, -1}, 60);
    SeenPicture const seen = look(world, camera, 161, 81);
    SeenSurface const& middle = seen.at(80, 40);
    EXPECT_TRUE(middle.in_mirror);
    EXPECT_NEAR(middle.depth, 4, 0.01f);
    EXPECT_NEAR(middle.albedo.z, 0.8f * 0.96f * 0.96f, 0.01f);
    EXPECT_TRUE(seen.at(86, 47).in_mirror && seen.at(86, 47).is_image);
    SeenSurface const& pane = seen.at(140, 40);
    EXPECT_TRUE(pane.in_mirror && !pane.is_image);
    EXPECT_NEAR(pane.depth, 4, 1e-3f);
    expect_near(pane.normal, {0, 0, 1}, 1e-4f, "normal");
    EXPECT_GT(pane.albedo.z, 0.8f * 0.85f);
    EXPECT_LT(pane.albedo.z, 0.8f * 0.95f);
    EXPECT_FALSE(seen.at(20, 40).in_mirror);
    EXPECT_NEAR(seen.at(20, 40).albedo.z, 0.8f, 1e-5f);
}

TEST(SeenSurfaces, WhatShinesByItselfIsSeenBesideWhatItMirrors)
{
    Scene scene;
    Material shining = mirror(vec3{0.5f});
    shining.emission = {1, 2, 3};
    shining.double_sided = true;
    add_quad(scene, {-3, -3, -2}, {6, 0, 0}, {0, 6, 0}, add_material(scene, shining));
    set_environment(scene, vec3{4});
    SeenSurface const s = look(world_of(scene), look_at({0, 0, 0}, {0, 0, -1}, 10), 9, 9).middle();
    expect_near(s.emitted, {3, 4, 5}, 0.01f, "own light and that of the environment");
    EXPECT_TRUE(s.in_mirror);
    EXPECT_EQ(s.depth, 0);
}

/// A thin pane reflects 2 F / (1 + F) with F = 0.04: of a lamp behind the eye that
/// is light besides what is behind it.
TEST(SeenSurfaces, APaneReflectsLampsToo)
{
    Scene scene;
    Material lamp = lambert(vec3{0});
    lamp.emission = vec3{10};
    lamp.double_sided = true;
    add_quad(scene, {-1, -1, 3}, {2, 0, 0}, {0, 2, 0}, add_material(scene, lamp));
    add_quad(scene, {-2, -2, -2}, {4, 0, 0}, {0, 4, 0}, add_material(scene, glass(1.5f, true)));
    add_quad(scene, {-9, -9, -4}, {18, 0, 0}, {0, 18, 0}, add_material(scene, lambert(vec3{0.5f})));
    SeenSurface const s = look(world_of(scene), look_at({0, 0, 0}, {0, 0, -1}, 10), 9, 9).middle();
    expect_near(s.emitted, vec3{10 * 0.08f / 1.04f}, 0.01f, "light of the lamp");
    EXPECT_NEAR(s.depth, 4, 1e-3f);
    EXPECT_NEAR(s.albedo.x, 0.5f * (1 - 0.08f / 1.04f), 0.005f);
}

/// A wall that moves 0.1 m towards the mirror also moves 0.1 m towards it in the reflection, from the other side.
TEST(SeenSurfaces, WhatMovesMovesInTheMirrorToo)
{
    auto scene = std::make_shared<Scene>();
    add_quad(*scene, {-3, -3, -2}, {6, 0, 0}, {0, 6, 0}, add_material(*scene, mirror(vec3{1})));
    add_quad(*scene, {-9, -9, 1}, {0, 18, 0}, {18, 0, 0}, add_material(*scene, lambert(vec3{0.5f})));
    scene->nodes[1].driven = true;
    Report report;
    MovingWorld moving(scene, 0, report);
    SeenSurfaces seen(moving.world(), 0);
    CameraRays const rays = camera_rays(look_at({0, 0, 0}, {0, 0, -1}, 60), 20, 20, moving.world().origin);
    EXPECT_EQ(look(seen, rays, 20, 20).middle().moved, vec3{0});
    Pose pose = evaluate_pose(*scene, 0);
    auto const move_to = [&](double x, double z) {
        pose.world_from_node[1] = glm::translate(dmat4(1), dvec3{x, 0, z});
        seen.end_frame();
        seen.changed(moving.advance(pose));
    };
    move_to(0.05, -0.1);
    SeenSurface s = look(seen, rays, 20, 20).middle();
    expect_near(s.moved, {0.05f, 0, 0.1f}, 1e-5f, "moved");
    EXPECT_NEAR(s.depth, 4.9f, 1e-3f);
    seen.end_frame();
    seen.changed({});
    EXPECT_EQ(look(seen, rays, 20, 20).middle().moved, vec3{0});
}

TEST(SeenSurfaces, MaterialsThatBecomeMirrorsAreFollowed)
{
    auto scene = std::make_shared<Scene>();
    add_quad(*scene, {-3, -3, -2}, {6, 0, 0}, {0, 6, 0}, add_material(*scene, lambert(vec3{0.5f})));
    add_quad(*scene, {-9, -9, 1}, {0, 18, 0}, {18, 0, 0}, add_material(*scene, lambert({1, 0, 0})));
    Report report;
    MovingWorld moving(scene, 0, report);
    SeenSurfaces seen(moving.world(), 0);
    CameraRays const rays = camera_rays(look_at({0, 0, 0}, {0, 0, -1}, 60), 20, 20, moving.world().origin);
    EXPECT_FALSE(seen.has_mirrors());
    EXPECT_NEAR(look(seen, rays, 20, 20).middle().depth, 2, 1e-4f);
    seen.changed(moving.set_material(0, mirror(vec3{1})));
    EXPECT_TRUE(seen.has_mirrors());
    EXPECT_NEAR(look(seen, rays, 20, 20).middle().depth, 5, 1e-3f);
    seen.changed(moving.set_material(0, lambert(vec3{0.5f})));
    EXPECT_FALSE(seen.has_mirrors());
    EXPECT_NEAR(look(seen, rays, 20, 20).middle().depth, 2, 1e-4f);
}

} // namespace
} // namespace gi::test
