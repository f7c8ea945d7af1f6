// The light of few punctual lights on the surfaces that are seen is that which methods find, and a method that
// leaves it out lacks just that.

#include "gi/hit_buffers/settings.h"
#include "gi/methods/registry.h"
#include "tests/surfaces/seen_picture.h"

#include <glm/gtc/matrix_transform.hpp>

namespace gi::test {
namespace {

constexpr int kSize = 48, kFiner = 4;

/// A floor with a block that throws a shadow.
Scene floor_with_block()
{
    Scene scene;
    add_quad(scene, {-2, 0, 2}, {4, 0, 0}, {0, 0, -4}, add_material(scene, lambert({0.7f, 0.6f, 0.5f})));
    add_box(scene, {-0.4f, 0, -0.4f}, {0.3f, 0.8f, 0.2f}, add_material(scene, lambert({0.2f, 0.5f, 0.8f})), false);
    return scene;
}

Camera eye() { return look_at({-1.4, 1.3, 1.9}, {0.1, 0.3, 0}, 55); }

Light point_light(vec3 at, float intensity)
{
    return {.position = at, .intensity = vec3{intensity, 0.8f * intensity, 0.5f * intensity}};
}

Light sun() { return {.type = LightType::directional, .direction = {0.6f, -1, -0.4f}, .intensity = vec3{3}}; }

/// Mean over the pixels of a finer view, as the paths of a method take it.
std::vector<vec3> direct_light(World const& world)
{
    SeenPicture const fine = look(world, eye(), kSize * kFiner, kSize * kFiner, SeenSurfaces::Lights::few);
    std::vector<vec3> sum(kSize * kSize, vec3{0});
    for (int y = 0; y < fine.height; ++y)
        for (int x = 0; x < fine.width; ++x)
            sum[std::size_t(y / kFiner * kSize + x / kFiner)] += fine.at(x, y).direct / float(kFiner * kFiner);
    return sum;
}

TEST(SeenLight, IsThatOfTheReferenceShadowEdgesIncluded)
{
    for (Light const& light : {sun(), point_light({1, 1.5f, 0.8f}, 5)}) {
        Scene scene = floor_with_block();
        add_light(scene, light);
        World const world = world_of(scene);
        RenderSettings s;
        s.width = s.height = kSize;
        s.paths = 64;
        s.bounces = 0;
        Report report;
        Picture const truth = find_method("reference").render(world, eye(), s, {}, {}, report).picture;
        std::vector<vec3> const direct = direct_light(world);
        double sum = 0, expected = 0, off = 0;
        for (std::size_t i = 0; i < direct.size(); ++i) {
            vec3 const t = rgb(*truth.find("L1"), i);
            sum += double(luminance(direct[i]));
            expected += double(luminance(t));
            off += double(std::abs(luminance(direct[i] - t)));
        }
        ASSERT_GT(expected, 0);
        EXPECT_NEAR(sum / expected, 1, 0.005);
        EXPECT_LT(off / expected, 0.02); // of edges, in which the reference is noisy
    }
}

TEST(SeenLight, OfNoneAndOfMoreThanFourIsNone)
{
    for (std::size_t const count : {std::size_t(0), SeenSurfaces::kMostLights, SeenSurfaces::kMostLights + 1}) {
        Scene scene = floor_with_block();
        for (std::size_t k = 0; k < count; ++k) add_light(scene, point_light({0, 2, float(k)}, 1));
        World const world = world_of(scene);
        bool const few = count == SeenSurfaces::kMostLights;
        EXPECT_EQ(SeenSurfaces::has_few_lights(world), few);
        double sum = 0;
        for (vec3 const v : direct_light(world)) sum += double(luminance(v));
        EXPECT_EQ(sum > 0, few);
        for (SeenSurface const& s : look(world, eye(), 8, 8, SeenSurfaces::Lights::none).pixels)
            EXPECT_EQ(s.direct, vec3{0});
    }
}

/// Pixels whose light is not that of a shadow ray of their own.
std::size_t unlike_by_rays(World const& world, Camera const& camera, int size)
{
    SeenPicture const seen = look(world, camera, size, size, SeenSurfaces::Lights::few);
    CameraRays const rays = camera_rays(camera, size, size, world.origin);
    ExactVisibility const exact(world, false, 0);
    WorldView const w = view(world);
    std::size_t other = 0;
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) {
            RayQuery const query{.ray = rays.through({float(x) + 0.5f, float(y) + 0.5f})};
            Hit hit;
            exact.nearest({&query, 1}, {&hit, 1});
            vec3 truth{0};
            if (hit.triangle != kNoTriangle) {
                ShadingPoint const at = shading_point(w, hit.triangle, hit.barycentric, query.ray.direction);
                for (Light const& light : world.lights) {
                    bool const far = light.type == LightType::directional;
                    vec3 const way = light.position - at.position,
                               to = far ? -light.direction : glm::normalize(way);
                    float const cosine = glm::dot(to, at.frame.normal);
                    RayQuery shadow{.ray = {leave(at, to), to}};
                    if (!far) shadow.reach = 0.999f * glm::length(way);
                    std::uint8_t blocked = 0;
                    exact.occluded({&shadow, 1}, {&blocked, 1});
                    if (blocked == 0 && cosine > 0)
                        truth +=
                            at.bsdf.diffuse * kInvPi * light.intensity * (cosine / (far ? 1 : glm::dot(way, way)));
                }
            }
            other += glm::length(seen.at(x, y).direct - truth) > 0.01f * (0.01f + glm::length(truth));
        }
    return other;
}

/// Several lights, each of whose shadows lies elsewhere: found together as by rays of every pixel.
TEST(SeenLight, CoarseShadowsAreThoseOfEveryPixel)
{
    Scene scene = floor_with_block();
    for (int k = 0; k < 4; ++k)
        add_light(scene, point_light({std::cos(1.5f * float(k)), 1.6f, std::sin(1.5f * float(k))}, 2));
    EXPECT_LT(unlike_by_rays(world_of(scene), eye(), 120), std::size_t(120 * 120) / 200); // slivers of shadow
}

/// A sun low over fine grooves, whose one side faces away from it: where pixels
/// around face away, that says nothing.
TEST(SeenLight, OfSurfacesBesideOthersThatFaceAway)
{
    Scene scene;
    int const material = add_material(scene, lambert(vec3{0.5f}));
    float const width = 0.021f, rise = width * std::tan(0.14f);
    for (int k = -50; k < 50; ++k)
        add_quad(scene, {width * float(k), k % 2 == 0 ? 0 : rise, 1}, {width, k % 2 == 0 ? rise : -rise, 0},
                 {0, 0, -2}, material);
    add_light(scene, {.type = LightType::directional, .direction = {1, -0.1f, 0}, .intensity = vec3{3}});
    EXPECT_LT(unlike_by_rays(world_of(scene), look_at({0, 2, 0.1}, {0, 0, 0}, 45), 80), std::size_t(80 * 80) / 50);
}

class LeftOutLight : public testing::TestWithParam<int> {};

/// L1 without, plus the light of the surfaces that are seen, is L1; nothing else changes.
TEST_P(LeftOutLight, LightIsJustThatOfTheSurfacesSeen)
{
    auto const scene = std::make_shared<Scene>(floor_with_block());
    add_light(*scene, point_light({1, 1.5f, 0.8f}, 5));
    add_light(*scene, sun());
    if (GetParam() == 1)
        add_quad(*scene, {-0.5f, 0, -1.2f}, {2.4f, 0, 0}, {0, 2, 0},
                 add_material(*scene, mirror({0.9f, 0.8f, 0.9f})));
    if (GetParam() == 2) {
        add_quad(*scene, {-1.6f, 0, 0.6f}, {2.4f, 0, 0}, {0, 2, 0}, add_material(*scene, glass(1.5f, true)));
        add_sphere(*scene, {0.8f, 0.4f, 0.3f}, 0.35f, 3, add_material(*scene, glass(1.5f, false)), true);
    }
    if (GetParam() == 3) { // glossy, not a mirror
        Material m = mirror(vec3{0.8f});
        m.roughness = 0.3f;
        add_quad(*scene, {-0.5f, 0, -1.2f}, {2.4f, 0, 0}, {0, 2, 0}, add_material(*scene, m));
    }
    Report report;
    RenderSettings s;
    s.width = s.height = kSize;
    s.bounces = 2;
    s.of<SlhbSettings>().schedule = Schedule::stored;
    s.of<SlhbSettings>().directions = "icosahedron:80";
    s.of<SlhbSettings>().resolution = 64;
    Picture pictures[2];
    for (bool const out : {false, true}) {
        MovingWorld const world(scene, 0, report);
        auto const frames = find_method("slhb").frames(world, eye(), s, report);
        ASSERT_NE(ask<PunctualLeftOut>(*frames), nullptr);
        ask<PunctualLeftOut>(*frames)->leave_out_punctual(out);
        FrameView const v{eye(), kSize, kSize};
        pictures[out ? 1 : 0] = frames->views({&v, 1}, 256, VertexSharing::cached, {})[0].picture;
    }
    std::vector<vec3> const direct = direct_light(world_of(*scene));
    auto const mean = [&](Picture const& p, char const* layer) {
        double sum = 0;
        for (std::size_t i = 0; i < p.pixels(); ++i) sum += double(luminance(rgb(*p.find(layer), i)));
        return sum / double(p.pixels());
    };
    double added = 0;
    for (vec3 const d : direct) added += double(luminance(d)) / double(direct.size());
    double const with = mean(pictures[0], "L1"), without = mean(pictures[1], "L1");
    EXPECT_GT(added, 0.5 * with);
    EXPECT_NEAR((without + added) / with, 1, 0.015);
    if (GetParam() == 0) {
        EXPECT_LT(without, 1e-6);
    }
    EXPECT_NEAR(mean(pictures[1], "L2") / mean(pictures[0], "L2"), 1, 0.03);
}

INSTANTIATE_TEST_SUITE_P(MattMirrorGlassGloss, LeftOutLight, testing::Values(0, 1, 2, 3));

TEST(LeftOut, OtherMethodsSayThatTheyCannot)
{
    Report report;
    auto const scene = std::make_shared<Scene>(floor_with_block());
    add_light(*scene, sun());
    MovingWorld const world(scene, 0, report);
    RenderSettings s;
    s.width = s.height = 8;
    EXPECT_EQ(ask<PunctualLeftOut>(*find_method("reference").frames(world, eye(), s, report)), nullptr);
}

} // namespace
} // namespace gi::test
