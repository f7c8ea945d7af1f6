#include "gi/hit_buffers/shadow_maps/light_points.h"
#include "gi/render/exact_visibility.h"
#include "gi/scene/generate/figure.h"
#include "gi/scene/motion/moving_world.h"
#include "tests/support/scenes.h"

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

namespace gi::test {
namespace {

enum class Source { rectangle, sky, point };

/// A figure that walks, and light of one kind.
std::shared_ptr<Scene const> walk(Source source)
{
    Scene scene;
    add_quad(scene, {-5, 0, 5}, {10, 0, 0}, {0, 0, -10}, add_material(scene, lambert(vec3{0.5f})));
    add_figure(scene, glm::translate(dmat4(1), dvec3{0, 0, 0}), 1);
    if (source == Source::rectangle) {
        Material light_point = lambert(vec3{0});
        light_point.emission = vec3{10};
        add_quad(scene, {-1, 4, -1}, {2, 0, 0}, {0, 0, 2}, add_material(scene, light_point));
    } else if (source == Source::sky) {
        set_environment(scene, vec3{1});
    } else {
        Light light;
        light.type = LightType::point;
        light.position = {0, 3, 2};
        light.intensity = vec3{10};
        add_light(scene, light);
    }
    return std::make_shared<Scene const>(std::move(scene));
}

class KeptLamps : public testing::TestWithParam<Source> {};

/// Whatever was kept and moved on: the maps are those of everything as it is now.
TEST_P(KeptLamps, HaveTheShadowsOfNow)
{
    Report report;
    MovingWorld moving(walk(GetParam()), 0, report);
    World const& world = moving.world();
    TriangleSoup soup = make_soup(world);
    CutOuts const cut_outs(world);
    Bounds bounds = world.bounds;
    bounds.low -= vec3{1};
    bounds.high += vec3{1};
    ASSERT_LT(world.static_triangles, world.triangles.size());
    vec3 const half = 0.2f * (bounds.high - bounds.low);
    std::vector<Bounds> const windows{{bounds.center() - half, bounds.center() + half}};
    LightPoints light_points(world, bounds, soup, cut_outs,
                             {.count = 5,
                              .fresh = 2,
                              .resolution = 32,
                              .windows = windows,
                              .seed = 3,
                              .first_moving = world.static_triangles});
    ShadowMapBuilder const builder(bounds, windows, soup, cut_outs, 32);
    std::size_t covered = 0, taken = 0;
    for (std::uint32_t pass = 0; pass < 8; ++pass) {
        if (pass % 3 != 1) {
            moving.advance(0.1 * pass);
            update_soup(world, world.static_triangles, soup);
            light_points.moved();
        }
        light_points.refresh(pass);
        ASSERT_EQ(light_points.fixed(), GetParam() == Source::point);
        for (LightPoint const& light_point : light_points.light_points()) {
            ShadowMap anew = light_point.shadow;
            for (int face = 0; face < 6; ++face) {
                builder.build(light_point.view, face, soup.count, 0, anew);
                auto const& now = light_point.shadow.maps[std::size_t(face)].texels;
                auto const& expected = anew.maps[std::size_t(face)].texels;
                ASSERT_EQ(now.size(), expected.size());
                for (std::size_t t = 0; t < now.size(); ++t) {
                    ASSERT_EQ(now[t].primitive, expected[t].primitive) << pass << ", " << face << ", " << t;
                    ASSERT_EQ(now[t].key, expected[t].key);
                    covered += now[t].primitive != kNoPrimitive;
                    taken += now[t].primitive != kNoPrimitive && now[t].primitive >= world.static_triangles;
                }
            }
        }
    }
    EXPECT_GT(covered, 0u);
    EXPECT_GT(taken, 20u); // else nothing was tested
}

INSTANTIATE_TEST_SUITE_P(Of, KeptLamps, testing::Values(Source::rectangle, Source::sky, Source::point));

/// Points in a room under a roof with an opening, on its outside, and on the ground around it.
TEST(ShadowMap, OnlyTexelsThatDisagreeMaySayTheWrongThing)
{
    Scene scene;
    int const m = add_material(scene, lambert(vec3{0.5f}));
    add_quad(scene, {-6, -0.1, 6}, {12, 0, 0}, {0, 0, -12}, m);
    for (float const x : {-2.0f, 1.9f}) add_box(scene, {x, 0, -2}, {x + 0.1f, 2, 2}, m, false);
    for (float const z : {-2.0f, 1.9f}) add_box(scene, {-1.9f, 0, z}, {1.9f, 2, z + 0.1f}, m, false);
    add_box(scene, {-2.2f, 2, -2.2f}, {0.6f, 2.1f, 2.2f}, m, false); // a roof with an opening beside it
    World const world = world_of(scene);
    TriangleSoup const soup = make_soup(world);
    CutOuts const cut_outs(world);
    ExactVisibility const exact(world, false, 1);
    Pcg32 rng(2, 9);
    std::size_t wrong_single = 0, wrong_certain = 0, some = 0, n = 0;
    for (bool const parallel : {true, false})
        for (int map = 0; map < 10; ++map) {
            vec3 const at{rng.uniform() - 0.5f, 1, rng.uniform() - 0.5f};
            ShadowView const from{parallel, parallel ? glm::normalize(at) : 12.0f * at, vec3{0}};
            ShadowMapBuilder const builder(world.bounds, {}, soup, cut_outs, 256);
            ShadowMap shadow;
            builder.start(from, rng.uniform2(), 6 * rng.uniform(), shadow);
            for (int face = 0; face < 6; ++face) builder.build(from, face, soup.count, 0, shadow);
            for (int k = 0; k < 1000; ++k) {
                auto const t = std::uint32_t(rng.next() % world.triangles.size());
                Surface const& s = world.surfaces[t];
                vec2 u = rng.uniform2();
                if (u.x + u.y > 1) u = 1.0f - u;
                vec3 const point = s.corner + u.x * s.edge1 + u.y * s.edge2,
                           normal = glm::normalize(glm::cross(s.edge1, s.edge2)),
                           way = parallel ? from.at : from.at - point, towards = glm::normalize(way);
                if (glm::dot(normal, towards) < 0.05f) continue; // no light falls on it
                RayQuery const ray{.ray = {point + s.clearance * normal, towards},
                                   .reach = parallel ? RayQuery::kFar : glm::length(way)};
                std::uint8_t blocked = 0;
                exact.occluded({&ray, 1}, {&blocked, 1});
                ShadowPlace const place = shadow.look(point, normal, rng.uniform2());
                ++n;
                wrong_single += shadow.lit(place, world.surfaces, point, t) == (blocked != 0);
                switch (shadow.lit_by(place, world.surfaces, point, normal, t)) {
                case LitBy::some:
                    ++some;
                    break;
                case LitBy::all:
                    wrong_certain += blocked;
                    break;
                case LitBy::none:
                    wrong_certain += 1 - blocked;
                    break;
                }
            }
        }
    std::cout << n << " points, " << wrong_single << " wrong by one texel, " << some << " doubtful by four, "
              << wrong_certain << " of the others wrong\n";
    EXPECT_GT(wrong_single, n / 200) << "else nothing was tested";
    EXPECT_LT(some, n / 5);
    EXPECT_LE(wrong_certain, n / 2000);
}

TEST(LightPoints, PointsAreSuccessiveOnesHoweverFewAreFresh)
{
    Report report;
    World const world = build_world(walk(Source::rectangle), 0, report);
    TriangleSoup const soup = make_soup(world);
    CutOuts const cut_outs(world);
    LightPoints few(world, world.bounds, soup, cut_outs, {.count = 4, .fresh = 1, .resolution = 8, .seed = 3}),
        all(world, world.bounds, soup, cut_outs, {.count = 4, .fresh = 4, .resolution = 8, .seed = 3});
    for (std::uint32_t pass = 0; pass <= 4; ++pass) few.refresh(pass);
    all.refresh(1);
    EXPECT_EQ(few.maps_built(), 8u);
    for (std::size_t k = 0; k < 4; ++k) {
        EXPECT_EQ(few.light_points()[k].number, all.light_points()[k].number);
        EXPECT_EQ(few.light_points()[k].u, all.light_points()[k].u);
    }
}

} // namespace
} // namespace gi::test
