// Where impostors are put, in scenes of all kinds.

#include "gi/core/error.h"
#include "gi/core/threads.h"
#include "gi/light_paths/impostor_places.h"
#include "gi/light_paths/reached_points.h"
#include "tests/light_paths/impostor_scenes.h"

#include <fmt/format.h>

namespace gi::test {
namespace {

std::vector<vec3> places_of(World const& world, ImpostorPlacement const& placement = {})
{
    std::vector<vec3> const places = place_impostors(world, ExactVisibility(world, false, 0), placement);
    EXPECT_LE(places.size(), placement.count);
    for (vec3 const p : places) EXPECT_TRUE(all_finite(p));
    return places;
}

bool within(vec3 p, vec3 low, vec3 high)
{
    return glm::all(glm::greaterThan(p, low)) && glm::all(glm::lessThan(p, high));
}

/// Share of the points that light reaches which some impostor sees.
double share_seen(World const& world, std::vector<vec3> const& places)
{
    ExactVisibility const visibility(world, false, 0);
    std::size_t seen = 0;
    std::vector<ReachedPoint> const points = reach(world, visibility, 500, 99).points;
    for (ReachedPoint const& p : points) {
        std::uint8_t blocked = 1;
        for (std::size_t k = 0; k < places.size() && blocked != 0; ++k) {
            vec3 const to = places[k] - p.position;
            if (!(glm::dot(to, p.normal) > 0)) continue;
            RayQuery const query{.ray = {p.position + p.clearance * p.normal, glm::normalize(to)},
                                 .reach = glm::length(to)};
            visibility.occluded({&query, 1}, {&blocked, 1});
        }
        seen += blocked == 0;
    }
    return points.empty() ? 1 : double(seen) / double(points.size());
}

Scene two_rooms()
{
    Scene scene;
    int const matt = add_material(scene, lambert(vec3{0.5f}));
    add_box(scene, {0, 0, 0}, {4, 3, 4}, matt, true);
    add_box(scene, {1.95f, 0, 0}, {2.05f, 3, 3.5f}, matt, false); // a wall with a passage
    return scene;
}

TEST(ImpostorPlaces, CoverAClosedRoom)
{
    World const world = box_room({0, 0, 0}, {4, 3, 5});
    for (std::uint32_t const count : {1u, 4u, 16u}) {
        std::vector<vec3> const places = places_of(world, {.count = count});
        ASSERT_GE(places.size(), 1u);
        // Without lights and cameras walks start on both sides, and it cannot be known that nothing is outside.
        std::size_t inside = 0;
        for (vec3 const p : places) inside += within(p, {0, 0, 0}, {4, 3, 5});
        EXPECT_GE(inside, 1u);
    }
}

TEST(ImpostorPlaces, AreWhereTheLightIs)
{
    Scene scene = two_rooms();
    add_light(scene, {.position = {1, 2, 1}});
    World const world = world_of(scene);
    std::vector<vec3> const places = places_of(world);
    ASSERT_GE(places.size(), 2u);
    std::size_t left = 0, right = 0;
    for (vec3 const p : places) {
        EXPECT_TRUE(within(p, {0, 0, 0}, {4, 3, 4}));
        EXPECT_FALSE(within(p, {1.95f, 0, 0}, {2.05f, 3, 3.5f}));
        (p.x < 2 ? left : right) += 1;
    }
    EXPECT_GE(left, 1u);
    EXPECT_GE(right, 1u);
    double const seen = share_seen(world, places);
    EXPECT_GT(seen, 0.99);
    EXPECT_LT(share_seen(world, places_of(world, {.count = 1})), seen); // one cannot see round the wall
}

TEST(ImpostorPlaces, KeepAwayFromSurfaces)
{
    Scene scene;
    add_box(scene, {0, 0, 0}, {4, 3, 5}, add_material(scene, lambert(vec3{0.5f})), true);
    add_light(scene, {.position = {2, 2, 2}});
    std::vector<vec3> const places = places_of(world_of(scene));
    ASSERT_GE(places.size(), 2u);
    double sum = 0;
    for (vec3 const p : places) sum += double(std::min({p.x, p.y, p.z, 4 - p.x, 3 - p.y, 5 - p.z}));
    EXPECT_GT(sum / double(places.size()), 0.5); // points uniform in the room have 0.45
    vec3 const first = places.front();
    EXPECT_GT(std::min({first.x, first.y, first.z, 4 - first.x, 3 - first.y, 5 - first.z}), 0.7f);
}

TEST(ImpostorPlaces, FindARoomInALargeWorld)
{
    Scene scene;
    int const matt = add_material(scene, lambert(vec3{0.5f}));
    add_box(scene, {-2, 0, -2}, {2, 3, 2}, matt, true);
    add_quad(scene, {-5000, 0, -5000}, {0, 0, 10000}, {10000, 0, 0}, matt);
    scene.cameras.push_back(look_at({0, 1.5, 1}, {0, 1.5, 0}, 60));
    Node node;
    node.camera = 0;
    node.translation = {0, 1.5, 1};
    scene.nodes.push_back(node);
    set_environment(scene, vec3{1});
    World const world = world_of(scene);
    ASSERT_EQ(world.cameras.size(), 1u);
    std::vector<vec3> const places = places_of(world);
    std::size_t inside = 0, outside = 0;
    for (vec3 const p : places) {
        vec3 const q = p + vec3(world.origin);
        (within(q, {-2, 0, -2}, {2, 3, 2}) ? inside : outside) += 1;
    }
    EXPECT_GE(inside, 1u);
    EXPECT_GE(outside, 1u);
}

TEST(ImpostorPlaces, AreAboveAPlane)
{
    Scene scene;
    add_quad(scene, {-20, 0, -20}, {0, 0, 40}, {40, 0, 0}, add_material(scene, lambert(vec3{0.5f})));
    add_light(scene, {.type = LightType::directional, .direction = glm::normalize(vec3{0.3f, -1, 0.2f})});
    World const world = world_of(scene);
    std::vector<vec3> const places = places_of(world);
    ASSERT_GE(places.size(), 1u);
    for (vec3 const p : places) EXPECT_GT(p.y, 0.5f);
    EXPECT_EQ(share_seen(world, places), 1);
    Impostors const impostors(world, places, 64);
    ExactVisibility const visibility(world, false, 1);
    std::vector<PathQuery> rays;
    Pcg32 rng(4, 4);
    for (int k = 0; k < 1000; ++k) {
        vec3 d = random_direction(rng);
        rays.push_back({{.ray = {{20 * rng.uniform() - 10, 2, 20 * rng.uniform() - 10}, d}}});
    }
    EXPECT_LT(accuracy(world, impostors, {}, visibility, rays).wrong, 0.01);
}

TEST(ImpostorPlaces, AreNoneInAnEmptyScene)
{
    World const world = world_of(Scene{});
    EXPECT_TRUE(places_of(world).empty());
    Impostors const impostors(world, {}, 64);
    PathQuery query{{.ray = {{0, 0, 0}, {0, 1, 0}}}};
    Hit hit{.triangle = 3};
    ImpostorRays(world, impostors).nearest({&query, 1}, {&hit, 1});
    EXPECT_EQ(hit.triangle, kNoTriangle);
    // Impostors where nothing is are no harm either.
    Impostors const alone(world, {{1, 1, 1}}, 64);
    hit.triangle = 3;
    ImpostorRays(world, alone).nearest({&query, 1}, {&hit, 1});
    EXPECT_EQ(hit.triangle, kNoTriangle);
}

TEST(ImpostorPlaces, SeeOneTriangle)
{
    Scene scene;
    Mesh& mesh = scene.meshes.emplace_back();
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 1}};
    mesh.triangles = {{0, 1, 2}};
    scene.nodes.emplace_back().meshes = {0};
    World const world = world_of(scene);
    std::vector<vec3> const places = places_of(world);
    ASSERT_GE(places.size(), 1u);
    Impostors const impostors(world, places, 64);
    ExactVisibility const visibility(world, false, 1);
    std::vector<PathQuery> rays;
    Pcg32 rng(4, 5);
    for (int k = 0; k < 1000; ++k) {
        vec3 const from = vec3{0.3f} + 2.0f * random_direction(rng);
        vec3 const to = vec3{0.3f} + 0.5f * random_direction(rng);
        rays.push_back({{.ray = {from, glm::normalize(to - from)}}});
    }
    EXPECT_LT(accuracy(world, impostors, {}, visibility, rays).wrong, 0.05);
}

TEST(ImpostorPlaces, DoNotDependOnTheScale)
{
    std::vector<std::size_t> counts;
    for (float const scale : {1e-3f, 1.0f, 1e5f}) {
        Scene scene;
        int const matt = add_material(scene, lambert(vec3{0.5f}));
        add_box(scene, vec3{0}, scale * vec3{4, 3, 4}, matt, true);
        add_box(scene, scale * vec3{1.9f, 0, 0}, scale * vec3{2.1f, 3, 3}, matt, false);
        add_light(scene, {.position = scale * vec3{1, 2, 1}});
        World const world = world_of(scene);
        std::vector<vec3> const places = places_of(world);
        counts.push_back(places.size());
        ExactVisibility const visibility(world, false, 1);
        std::vector<PathQuery> rays;
        for (Flight const& f : reach(world, visibility, 1000, 7).flights)
            rays.push_back({{.ray = {f.from, f.direction}}, f.leaves});
        ASSERT_GT(rays.size(), 1000u);
        EXPECT_LT(accuracy(world, Impostors(world, places, 64), {}, visibility, rays).wrong, 0.01) << scale;
    }
    for (std::size_t const n : counts) EXPECT_NEAR(double(n), double(counts[1]), 2);
}

TEST(ImpostorPlaces, AreTheSameForAnyNumberOfThreads)
{
    Scene scene = two_rooms();
    add_light(scene, {.position = {1, 2, 1}});
    World const world = world_of(scene);
    std::vector<vec3> one, all = places_of(world);
    on_threads(1, [&] { one = places_of(world); });
    EXPECT_EQ(one, all);
}

TEST(ImpostorPlaces, GivenByHand)
{
    std::vector<dvec3> const two = read_impostor_places("0,1.5,-2; 4e1 , 1,2;");
    ASSERT_EQ(two.size(), 2u);
    EXPECT_EQ(two[0], dvec3(0, 1.5, -2));
    EXPECT_EQ(two[1], dvec3(40, 1, 2));
    std::string many;
    for (std::size_t k = 0; k <= kMostImpostors; ++k) many += "0,0,0;";
    for (std::string const& wrong :
         {std::string(""), std::string(";"), std::string("1,2"), std::string("1,2,3,4"), std::string("1,2,x"),
          std::string("1,2,"), std::string("1,2,nan"), std::string("inf,2,3"), std::string("1e300,2,3"),
          std::string("1,2,3;;4,5,6"), many})
        EXPECT_THROW(read_impostor_places(wrong), InputError) << wrong;
}

/// A small lit room in a world of 400 m: with a focus, places are in and about the room.
TEST(ImpostorPlaces, NearTheFocus)
{
    Scene scene;
    int const matt = add_material(scene, lambert(vec3{0.5f}));
    add_quad(scene, {-200, 0, -200}, {0, 0, 400}, {400, 0, 0}, matt);
    add_quad(scene, {-2, 2, -2}, {4, 0, 0}, {0, 0, 4}, matt); // a roof
    Light sun;
    sun.type = LightType::directional;
    sun.direction = {0.3f, -1, 0.2f};
    sun.intensity = vec3{1};
    add_light(scene, sun);
    World const world = world_of(scene);
    Bounds const focus{vec3{-4, -1, -4}, vec3{4, 5, 4}};
    auto const share_near = [&](std::vector<vec3> const& places) {
        auto const near = std::ranges::count_if(places, [](vec3 p) { return within(p, vec3{-12}, vec3{12}); });
        return double(near) / double(places.size());
    };
    std::vector<vec3> const about = places_of(world, {.focus = focus}), anywhere = places_of(world);
    ASSERT_FALSE(about.empty());
    EXPECT_TRUE(std::ranges::any_of(about, [](vec3 p) { return within(p, {-2, 0, -2}, {2, 2, 2}); }));
    fmt::print("near the focus: {:.2f} of the places, {:.2f} without one\n", share_near(about),
               share_near(anywhere));
    EXPECT_GT(share_near(about), 2 * share_near(anywhere));
}

} // namespace
} // namespace gi::test
