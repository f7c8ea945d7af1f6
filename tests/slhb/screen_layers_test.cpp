// One layered hit buffer of the view: rays meet what the view shows as exact rays do, and nothing else.

#include "gi/methods/paths/screen_layers.h"

#include "gi/methods/paths/paths.h"
#include "gi/methods/reference/reference.h"
#include "gi/render/exact_visibility.h"
#include "gi/scene/generate/generate.h"
#include "gi/scene/model/projection.h"
#include "tests/slhb/slhb_render.h"

namespace gi::test {
namespace {

World cornell()
{
    Report report;
    return build_world(std::make_shared<Scene const>(generate_cornell()), std::nullopt, report);
}

TEST(ScreenLayers, MeetWhatExactRaysMeetWithinTheView)
{
    World const world = cornell();
    constexpr int kPixels = 96;
    CameraRays const eye = camera_rays(world.cameras.at(0), kPixels, kPixels, world.origin);
    TriangleSoup const soup = make_soup(world);
    CutOuts const cut_outs(world);
    ScreenLayers layers;
    layers.draw(soup, soup.count, cut_outs, eye, kPixels, kPixels, 256, vec2{0.5f}, 1e-4f, 0);
    ExactVisibility const exact(world, false, 1);
    Projection const projection(eye);
    Pcg32 rng(4, 4);
    bool near = false;
    std::size_t met = 0, same = 0, invented = 0, beside = 0;
    for (int k = 0; k < 20000; ++k) {
        Ray const first = eye.through(vec2{float(kPixels) * rng.uniform(), float(kPixels) * rng.uniform()});
        RayQuery ray{.ray = first};
        Hit hit;
        exact.nearest({&ray, 1}, {&hit, 1});
        if (hit.triangle == kNoTriangle) continue;
        Surface const& s = world.surfaces[hit.triangle];
        vec3 n = glm::normalize(glm::cross(s.edge1, s.edge2));
        if (glm::dot(n, first.direction) > 0) n = -n;
        vec3 const origin = first.origin + hit.distance * first.direction,
                   way = Frame::about(n).to_world(square_to_cosine_hemisphere(rng.uniform2()));
        LayerHit const found = layers.nearest(world.surfaces, origin, hit.triangle, way, kNoPrimitive, near);
        ray = {.ray = {origin + s.clearance * n, way}};
        Hit truth;
        exact.nearest({&ray, 1}, {&truth, 1});
        vec3 const at = origin + truth.distance * way, place = projection(at);
        bool const shown = truth.triangle != kNoTriangle && place.z > 0 && place.x > 1 && place.y > 1 &&
                           place.x < kPixels - 1 && place.y < kPixels - 1;
        if (shown) {
            ++met;
            same +=
                found.triangle != kNoLayerHit && glm::length(found.position - at) < 0.03f * world.bounds.radius();
        } else {
            ++beside;
            invented += found.triangle != kNoLayerHit;
        }
    }
    std::cout << met << " rays meet what is shown, " << met - same << " of them something else; of " << beside
              << " others " << invented << " meet something\n";
    EXPECT_GT(same, met * 98 / 100);
    EXPECT_LT(invented, beside / 20);
}

double mean_indirect(RenderFunction render, World const& world, Camera const& camera, std::uint32_t paths)
{
    Report report;
    Picture const picture = render(world, camera, small_settings(32, paths, 3), {}, {}, report).picture;
    std::vector<float> const& light = picture.find("L2")->data;
    return std::accumulate(light.begin(), light.end(), 0.0) / double(light.size());
}

TEST(ScreenLayers, IndirectLightIsThatOfTheView)
{
    World const box = cornell();
    double const all = mean_indirect(render_screen_lhb, box, box.cameras.at(0), 256),
                 truth = mean_indirect(render_reference, box, box.cameras.at(0), 1024);
    Scene closed;
    add_box(closed, {-1, -1, -1}, {1, 1, 1}, add_material(closed, lambert(vec3{0.7f})), true);
    add_quad(closed, {-0.3f, 0.99f, -0.3f}, {0.6f, 0, 0}, {0, 0, 0.6f}, add_material(closed, emitter(vec3{5})));
    World const room = world_of(std::move(closed));
    Camera const narrow = look_at({-0.9, 0, 0}, {1, -0.7, 0.1}, 60); // a corner of wall and floor
    double const part = mean_indirect(render_screen_lhb, room, narrow, 128),
                 whole = mean_indirect(render_reference, room, narrow, 256);
    std::cout << all / truth << " of the indirect light where the view shows all, " << part / whole
              << " where it shows a part\n";
    EXPECT_NEAR(all, truth, 0.05 * truth);
    EXPECT_LT(part, 0.5 * whole) << "light from beside the view is missing: the method's failure";
    EXPECT_GT(part, 0);
}

TEST(ScreenLayers, DirectLightIsExact)
{
    Scene scene; // a room with a window, looked into from where it is not seen
    int const m = add_material(scene, lambert(vec3{0.6f}));
    add_box(scene, {-1, -1, -1}, {1, 1, 0.9f}, m, true);
    scene.meshes.back().triangles.resize(scene.meshes.back().triangles.size() - 1); // half of a wall is open
    set_environment(scene, vec3{1});
    World const world = world_of(std::move(scene));
    Camera const camera = look_at({0.2, 0.1, 0.5}, {-0.4, -0.6, -1}, 60);
    Report report;
    auto const direct = [&](RenderFunction render) {
        return mean_of(render(world, camera, small_settings(24, 512, 2), {}, {}, report).picture, "L1").mean;
    };
    double const truth = direct(render_reference);
    EXPECT_GT(truth, 0);
    EXPECT_NEAR(direct(render_screen_lhb), truth, 0.02 * truth);
}

TEST(ScreenLayers, NothingDegenerateAndFarStopsNothing)
{
    Scene scene;
    int const m = add_material(scene, lambert(vec3{0.5f}));
    add_quad(scene, {-1, -1, -3}, {2, 0, 0}, {0, 2, 0}, m);
    add_quad(scene, {-1, -1, -3}, {2, 0, 0}, {4, 0, 0}, m);             // without area
    add_quad(scene, {-1e6f, -2, -1e6f}, {0, 0, 2e6f}, {2e6f, 0, 0}, m); // far, and behind the eye
    World const world = world_of(std::move(scene));
    TriangleSoup const soup = make_soup(world);
    ScreenLayers layers;
    Camera const camera = look_at({0, 0, 0}, {0, 0, -1}, 90);
    bool near = false;
    layers.draw(soup, soup.count, CutOuts(world), camera_rays(camera, 7, 3, world.origin), 7, 3, 1, vec2{0}, 1e-5f, 0);
    for (vec3 const way : {vec3{0, 0, -1}, vec3{0, 0, 1}, vec3{1, 0, 0}, vec3{0, -1, 0}, vec3{0}, vec3{kInf}})
        for (vec3 const from :
             {vec3{0, 0, -3}, vec3{0}, vec3{1e30f, 0, -1}, vec3{-3, 3, -3}, vec3{-3.001f, 0, -3}})
            layers.nearest(world.surfaces, from, 0, way, kNoPrimitive, near); // ends
    layers.draw(soup, soup.count, CutOuts(world), camera_rays(camera, 64, 48, world.origin), 64, 48, 64, vec2{0.5f}, 1e-5f, 0);
    Pcg32 rng(1, 2);
    for (int k = 0; k < 2000; ++k) {
        vec3 const way = k == 0 ? vec3{0, 0, -1} : k == 1 ? vec3{0, 0, 1} : random_direction(rng);
        LayerHit const hit = layers.nearest(world.surfaces, {0.1f, 0.2f, -3}, 0, way, kNoPrimitive, near);
        if (hit.triangle == kNoLayerHit) continue;
        EXPECT_TRUE(all_finite(hit.position));
        EXPECT_LT(way.y, 0) << "only the ground is there to be met";
    }
    EXPECT_EQ(layers.nearest(world.surfaces, {0, 0, 5}, 0, {0, 0, -1}, kNoPrimitive, near).triangle, kNoLayerHit) << "behind the eye";
    Report report;
    Camera above = camera;
    above.orthographic = true;
    EXPECT_THROW(render_screen_lhb(world, above, small_settings(8, 1, 1), {}, {}, report), InputError);
}

} // namespace
} // namespace gi::test
