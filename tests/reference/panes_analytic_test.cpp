// Lamps without extent behind panes: all methods whose paths begin at the camera, against Fresnel's equations.

#include "gi/light_paths/settings.h"
#include "gi/methods/registry.h"
#include "gi/render/exact_visibility.h"
#include "gi/render/world_bvh.h"
#include "gi/scene/motion/moving_world.h"
#include "tests/support/scenes.h"

#include <gtest/gtest.h>

namespace gi::test {
namespace {

constexpr double kPaneFloor = 0.6;

/// Of a thin sheet with an index of refraction of 1.5: both faces, and all reflections between them.
double sheet_transmittance(double cosine)
{
    double const eta = 1.5, c = std::sqrt(1 - (1 - cosine * cosine) / (eta * eta));
    double const s = (cosine - eta * c) / (cosine + eta * c), p = (c - eta * cosine) / (c + eta * cosine);
    double const r = 0.5 * (s * s + p * p);
    return (1 - r) / (1 + r);
}

enum class PaneLamp { point, spot, sun };
constexpr dvec3 kAt{0.2, 0, -0.1}, kLamp{0.8, 2, 0.3};

/// A floor, a lamp, and sheets of these materials between them, of two triangles each.
Scene behind(std::vector<Material> const& sheets, PaneLamp lamp)
{
    Scene scene;
    Light light;
    light.intensity = vec3{5};
    light.position = vec3(kLamp);
    light.direction = vec3(glm::normalize(kAt - kLamp));
    light.type = lamp == PaneLamp::point  ? LightType::point
                 : lamp == PaneLamp::spot ? LightType::spot
                                          : LightType::directional;
    light.cos_inner = 0.9f;
    light.cos_outer = 0.8f;
    add_light(scene, light);
    add_quad(scene, {-50, 0, 50}, {100, 0, 0}, {0, 0, -100},
             add_material(scene, lambert(vec3{float(kPaneFloor)})));
    for (std::size_t k = 0; k < sheets.size(); ++k)
        add_quad(scene, {-9, 0.5f + 0.1f * float(k), 9}, {18, 0, 0}, {0, 0, -18}, add_material(scene, sheets[k]));
    return scene;
}

/// Radiance of the floor by direct light if nothing lies between.
double bare(PaneLamp lamp)
{
    dvec3 const way = kLamp - kAt;
    double const cosine = way.y / glm::length(way), area = lamp == PaneLamp::sun ? 1 : glm::dot(way, way);
    return kPaneFloor / glm::pi<double>() * 5 * cosine / area;
}
double cosine_at_sheets() { return (kLamp - kAt).y / glm::length(kLamp - kAt); }

Estimate radiance_behind(std::string const& method, World const& world)
{
    RenderSettings s;
    s.width = s.height = 8;
    s.paths = 256;
    s.bounces = 0;
    s.of<PhotonSettings>().caustic_paths = 0; // which find reflections between panes
    Report report;
    Estimate e = mean_of(find_method(method)
                             .render(world, orthographic(kAt + dvec3{0, 0.1, 0}, kAt, 1e-3), s, {}, {}, report)
                             .picture,
                         "L1");
    e.sigma = std::max(e.sigma, 1e-3 * e.mean);
    return e;
}

class Panes : public testing::TestWithParam<char const*> {};

TEST_P(Panes, LetTheLightOfLampsThrough)
{
    double const t = sheet_transmittance(cosine_at_sheets());
    Material const clear = glass(1.5f, true);
    Material half = clear, tinted = clear, veil = clear, hole = clear, metal = clear;
    half.transmission = 0.5f;
    tinted.base_color = {0.9f, 0.5f, 0.1f};
    veil.alpha_mode = AlphaMode::blend;
    veil.alpha = 0.25f;
    hole.alpha_mode = AlphaMode::mask;
    hole.alpha = 0.1f;
    metal.metallic = 1;
    for (PaneLamp const lamp : {PaneLamp::point, PaneLamp::spot, PaneLamp::sun}) {
        auto const expect = [&](std::vector<Material> const& sheets, double share, char const* what) {
            expect_estimate(radiance_behind(GetParam(), world_of(behind(sheets, lamp))), share * bare(lamp), what);
        };
        expect({}, 1, "nothing");
        expect({clear}, t, "a pane");
        expect({clear, clear, clear}, t * t * t, "three panes");
        expect({tinted, half}, 0.5 * 0.5 * t * t, "a tinted pane and one that is half opaque");
        expect({veil}, 0.75 + 0.25 * t, "a pane that covers a quarter");
        expect({hole}, 1, "a pane cut out");
        expect({metal}, 0, "a metal");
        expect({clear, glass(1.5f, false)}, 0, "a refracting sheet");
    }
}

INSTANTIATE_TEST_SUITE_P(Methods, Panes,
                         testing::Values("reference", "paths", "slhb", "paths_shadow_maps", "slhb_shadow_rays",
                                         "whitted", "vpl_exact"));

/// Embree and the project's own rays, with what stays and what moves.
TEST(Transmittance, IsThatOfEachPaneOnce)
{
    Scene scene = behind({glass(1.5f, true), glass(1.5f, true)}, PaneLamp::point);
    Material red = glass(1.5f, true);
    red.base_color = {0.8f, 0.1f, 0.1f};
    add_quad(scene, {-1, 0.9f, 1}, {2, 0, 0}, {0, 0, -2}, add_material(scene, red));
    add_quad(scene, {1.9f, 1.5f, 3.1f}, {1.2f, 0, 0}, {0, 0, -1.2f}, add_material(scene, lambert(vec3{0.5f})));
    World const world = world_of(scene);
    std::vector<RayQuery> rays;
    for (int z = -8; z <= 8; ++z) // also along the edges that two triangles share
        for (int x = -8; x <= 8; ++x)
            for (std::uint32_t const to_lamp : {0u, 1u}) {
                vec3 const from{0.5f * float(x), 0.001f, 0.5f * float(z)}, way = vec3{0, 3, 0} - from;
                rays.push_back(
                    {.ray = {from, glm::normalize(way)}, .reach = glm::length(way), .to_lamp = to_lamp});
            }
    for (std::size_t const first_moving : {std::size_t(2), std::size_t(6), world.triangles.size()}) {
        ExactVisibility const embree(world, false, 1, first_moving);
        WorldBvh<Space::host> own(view(world), false, first_moving);
        std::vector<vec3> left(rays.size());
        std::vector<std::uint8_t> blocked(rays.size());
        embree.transmittance(rays, left);
        embree.occluded(rays, blocked);
        std::size_t coloured = 0;
        for (std::size_t k = 0; k < rays.size(); ++k) {
            EXPECT_EQ(blocked[k], 1);                               // panes block what goes not to a lamp
            vec3 const from = rays[k].ray.origin, at = 0.7f * from; // where the rays meet the red pane
            double const t = sheet_transmittance(double(rays[k].ray.direction.y));
            bool const is_red = std::abs(at.x) < 1 && std::abs(at.z) < 1;
            vec3 expected = vec3(float(t * t)) * (is_red ? float(t) * red.base_color : vec3{1});
            if (rays[k].to_lamp == 0 || (from.x >= 4 && from.z >= 4)) expected = vec3{0};
            for (vec3 const& found : {left[k], own.rays().transmittance<true>(view(world), rays[k])})
                EXPECT_LT(max_component(glm::abs(found - expected)), 1e-5f) << from.x << ", " << from.z;
            coloured += is_red && rays[k].to_lamp == 1;
        }
        EXPECT_GT(coloured, 20u);
    }
}

/// A wall that becomes a pane while a picture is shown.
TEST(Transmittance, FollowsMaterials)
{
    for (char const* const method : {"paths", "slhb", "reference", "whitted"}) {
        Report report;
        MovingWorld moving(std::make_shared<Scene const>(behind({lambert(vec3{0.5f})}, PaneLamp::sun)), 0, report);
        RenderSettings s;
        s.width = s.height = 8;
        s.paths = 64;
        s.bounces = 0;
        Camera const camera = orthographic(kAt + dvec3{0, 0.1, 0}, kAt, 1e-3);
        auto const frames = find_method(method).frames(moving, camera, s, report);
        auto const picture = [&] { return mean_of(frames->frame(camera, {}, {}).picture, "L1").mean; };
        EXPECT_EQ(picture(), 0) << method;
        frames->changed(moving.set_material(1, glass(1.5f, true)));
        double const t = sheet_transmittance(cosine_at_sheets()), expected = t * bare(PaneLamp::sun);
        EXPECT_NEAR(picture(), expected, 0.005 * expected) << method;
        frames->changed(moving.set_material(1, lambert(vec3{0.5f})));
        EXPECT_EQ(picture(), 0) << method;
    }
}

} // namespace
} // namespace gi::test
