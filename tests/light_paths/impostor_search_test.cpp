// Rays by distance impostors against exact rays.

#include "gi/core/error.h"
#include "gi/light_paths/impostor_places.h"
#include "gi/light_paths/reached_points.h"
#include "gi/scene/generate/generate.h"
#include "tests/light_paths/impostor_scenes.h"

#include <limits>

namespace gi::test {
namespace {

constexpr ImpostorSearch kSearches[] = {ImpostorSearch::first_guess, ImpostorSearch::all, ImpostorSearch::cascaded,
                                        ImpostorSearch::walk};

TEST(ImpostorSearch, ErrsByLessThanATexelInAConvexRoom)
{
    World const world = box_room({-3, 0, -2}, {3, 2.5f, 2});
    ExactVisibility const visibility(world, false, 1);
    Impostors const impostors(world, {{-1.5f, 1.2f, 0.3f}, {1.4f, 1.3f, -0.2f}}, 64);
    std::vector<PathQuery> const rays = rays_from_surfaces(world, 4000, 5);
    std::vector<Hit> truth(rays.size());
    std::vector<PathQuery> copies = rays;
    ExactPathRays(visibility).nearest(copies, truth);
    for (ImpostorSearch const search : kSearches) {
        // With few steps the secant rule does not come to the end.
        std::vector<ImpostorHit> const found =
            how_followed(world, impostors, {.search = search, .iterations = 24}, rays);
        std::size_t within = 0;
        for (std::size_t k = 0; k < rays.size(); ++k) {
            float const off = std::abs(found[k].hit.distance - truth[k].distance);
            vec3 const at = rays[k].ray.ray.origin + truth[k].distance * rays[k].ray.ray.direction;
            vec3 const normal = shading_detail::triangle_normal(world.surfaces[truth[k].triangle]);
            float footprint = 0;
            for (vec3 const centre : impostors.view().centres) {
                float const seen_at = std::abs(glm::dot(glm::normalize(at - centre), normal));
                footprint =
                    std::max(footprint, impostors.view().texel_width() * glm::distance(at, centre) / seen_at);
            }
            float const limit = search == ImpostorSearch::walk
                                    ? 1e-4f
                                    : footprint / std::abs(glm::dot(rays[k].ray.ray.direction, normal));
            within += found[k].hit.triangle != kNoTriangle && off <= limit;
        }
        // The last few are near edges, where a texel holds another wall, or guessed at their own origin.
        double const share = double(within) / double(rays.size());
        EXPECT_GT(share, search == ImpostorSearch::walk ? 0.9999 : 0.95) << int(search);
    }
}

// The case of Fei and Wang's figure 1: as seen from the centre a pillar hides the ray's origin. The first guess is
// beyond the wall, the next ones are found to be behind the pillar, and all end at its wrong side.
TEST(ImpostorSearch, FanFindsWhatTheFirstGuessMisses)
{
    Scene scene;
    int const matt = add_material(scene, lambert(vec3{0.5f}));
    add_box(scene, vec3{-5}, vec3{5}, matt, true);
    add_box(scene, {1, -0.8f, -5}, {1.6f, 0.8f, 2}, matt, false);
    World const world = world_of(scene);
    ExactVisibility const visibility(world, false, 1);
    Impostors const impostors(world, {{0, 0, 0}, {0, -3.5f, 1}}, 128);
    for (vec3 const from : {vec3{4, 2, 0}, vec3{4, 1, 0}, vec3{0.75f, 0.75f, 0}}) {
        vec3 const direction = from.y == 1 ? vec3{1, -1, 0} : vec3{2, -3, 0};
        std::vector<PathQuery> rays;
        for (int k = 0; k < 27; ++k) { // and its neighbours
            vec3 const aside = vec3{k % 3, k / 3 % 3, k / 9} - 1.0f;
            vec3 const turned = glm::normalize(direction) + 0.01f * vec3{aside.z, aside.x, aside.y};
            rays.push_back({{.ray = {from + 0.03f * aside, glm::normalize(turned)}}});
        }
        auto const of = [&](ImpostorSettings const& s) { return accuracy(world, impostors, s, visibility, rays); };
        EXPECT_EQ(of({.search = ImpostorSearch::first_guess}).wrong, 1);
        // The other centre helps two of the rays, but not the third.
        EXPECT_EQ(of({.search = ImpostorSearch::all}).wrong, from.x < 1 ? 1 : 0);
        EXPECT_EQ(of({.search = ImpostorSearch::cascaded}).wrong, 0);
        EXPECT_LT(of({.search = ImpostorSearch::cascaded}).error, 0.01);
        EXPECT_EQ(of({}).wrong, 0);
        EXPECT_LT(of({}).error, 1e-5);
    }
}

// The energy as printed is least at the origin of a ray that leaves a surface.
TEST(ImpostorSearch, PrintedEnergyFindsTheOriginOfTheRay)
{
    World const world = box_room({-3, 0, -2}, {3, 2.5f, 2});
    ExactVisibility const visibility(world, false, 1);
    Impostors const impostors(world, {{0, 1.2f, 0}}, 128);
    std::vector<PathQuery> const rays = rays_from_surfaces(world, 2000, 6);
    double const printed =
        accuracy(world, impostors, {.search = ImpostorSearch::cascaded, .skip_texels = 0}, visibility, rays).wrong;
    double const skipped =
        accuracy(world, impostors, {.search = ImpostorSearch::cascaded}, visibility, rays).wrong;
    EXPECT_GT(printed, 0.3);
    EXPECT_LT(skipped, 0.05);
}

struct Expected {
    double guess_at_least, cascaded_below, walk_below, exact_above;
};

void check_accuracy(World const& world, Expected const& expected)
{
    ExactVisibility const visibility(world, false, 0);
    Impostors const impostors(world, place_impostors(world, visibility, {.count = 16}), 128);
    std::vector<PathQuery> const rays = rays_of_light(world, visibility, 12000, 77);
    ASSERT_GT(rays.size(), 4000u);
    Accuracy const guess = accuracy(world, impostors, {.search = ImpostorSearch::first_guess}, visibility, rays);
    Accuracy const all = accuracy(world, impostors, {.search = ImpostorSearch::all}, visibility, rays);
    Accuracy const cascaded = accuracy(world, impostors, {.search = ImpostorSearch::cascaded}, visibility, rays);
    Accuracy const walk = accuracy(world, impostors, {}, visibility, rays);
    EXPECT_GT(guess.wrong, expected.guess_at_least);
    EXPECT_LT(cascaded.wrong, expected.cascaded_below);
    EXPECT_LT(cascaded.wrong, all.wrong);
    EXPECT_LT(walk.wrong, expected.walk_below);
    EXPECT_LT(walk.error, 0.5 * std::min({guess.error, all.error, cascaded.error}));
    EXPECT_GT(walk.exact, expected.exact_above);
    // Rays into space that no centre sees use none.
    EXPECT_LE(guess.maps, 1);
    EXPECT_GT(guess.maps, 0.95);
    EXPECT_NEAR(all.maps, guess.maps * impostors.view().count(), 1e-6);
    for (Accuracy const& few : {cascaded, walk}) {
        EXPECT_GT(few.maps, guess.maps);
        EXPECT_LE(few.maps, 2);
    }
}

TEST(ImpostorSearch, IsRightInACornellBox)
{
    check_accuracy(world_of(generate_cornell()), {0.08, 0.15, 0.008, 0.8});
}

TEST(ImpostorSearch, IsMostlyRightInAnAtrium)
{
    check_accuracy(world_of(generate_atrium({.figure = false})), {0.2, 0.35, 0.1, 0.6});
}

TEST(ImpostorSearch, RespectsReachAndStart)
{
    World const world = box_room({-1, -1, -1}, {1, 1, 1});
    Impostors const impostors(world, {{0.1f, 0.2f, 0}}, 32);
    for (ImpostorSearch const search : kSearches) {
        ImpostorRays const rays(world, impostors, {.search = search});
        RayQuery const near{.ray = {{0, 0, 0}, {1, 0, 0}}, .reach = 0.8f}, far{.ray = near.ray, .reach = 1.2f},
            late{.ray = {{-2, 0, 0}, {1, 0, 0}}, .start = 1.5f};
        PathQuery queries[] = {{near}, {far}, {late}};
        Hit hits[3];
        rays.nearest(queries, hits);
        EXPECT_EQ(hits[0].triangle, kNoTriangle) << int(search);
        EXPECT_NEAR(hits[1].distance, 1, 0.08) << int(search);
        EXPECT_NEAR(hits[2].distance, 3, 0.08) << int(search);
    }
}

TEST(ImpostorSearch, PassesWhereAMaterialIsCutOut)
{
    Scene scene;
    int const wall = add_material(scene, lambert(vec3{0.5f}));
    Material cut = lambert(vec3{0.5f});
    cut.alpha_mode = AlphaMode::mask;
    cut.alpha = 0;
    Material solid = cut;
    solid.alpha = 1;
    add_box(scene, {-1, -1, -1}, {1, 1, 1}, wall, true);
    add_quad(scene, {0.5f, -1, -1}, {0, 2, 0}, {0, 0, 1}, add_material(scene, cut));
    add_quad(scene, {0.5f, -1, 0}, {0, 2, 0}, {0, 0, 1}, add_material(scene, solid));
    World const world = world_of(scene);
    Impostors const impostors(world, {{-0.1f, 0.05f, 0}}, 64);
    for (ImpostorSearch const search : kSearches) {
        ImpostorRays const rays(world, impostors, {.search = search});
        PathQuery queries[] = {{{.ray = {{0, 0, -0.3f}, {1, 0, 0}}}}, {{.ray = {{0, 0, 0.3f}, {1, 0, 0}}}}};
        Hit hits[2];
        rays.nearest(queries, hits);
        EXPECT_NEAR(hits[0].distance, 1, 0.03) << int(search);
        EXPECT_NEAR(hits[1].distance, 0.5, 0.03) << int(search);
    }
}

TEST(Impostors, FollowWhatMoves)
{
    Scene scene;
    int const matt = add_material(scene, lambert(vec3{0.5f}));
    add_box(scene, {-2, -2, -2}, {2, 2, 2}, matt, true);
    add_box(scene, {-0.5f, -0.5f, 0.5f}, {0.5f, 0.5f, 1}, matt, false);
    World world = world_of(scene);
    Impostors moved(world, {{0, 0, 0}, {-1, 1, -1}}, 32, 0, 12);
    for (std::size_t t = 12; t < world.triangles.size(); ++t) {
        for (glm::length_t k = 0; k < 3; ++k)
            if (t % 2 == 0 || k == 2) world.positions[world.triangles[t][k]] += vec3{0.7f, 0, 0};
        world.surfaces[t].corner += vec3{0.7f, 0, 0};
    }
    ImpostorsView const before = moved.view();
    std::vector<ImpostorTexel> const old(before.texels.begin(), before.texels.end());
    moved.moved(world);
    Impostors const fresh(world, {{0, 0, 0}, {-1, 1, -1}}, 32);
    std::size_t changed = 0;
    for (std::size_t k = 0; k < old.size(); ++k) {
        ASSERT_EQ(moved.view().texels[k].triangle, fresh.view().texels[k].triangle) << k;
        ASSERT_EQ(moved.view().texels[k].distance, fresh.view().texels[k].distance) << k;
        changed += old[k].distance != fresh.view().texels[k].distance;
    }
    EXPECT_GT(changed, 100u);
    for (std::size_t k = 0; k < moved.view().blocks.size(); ++k) {
        ASSERT_EQ(moved.view().blocks[k].nearest, fresh.view().blocks[k].nearest);
        ASSERT_EQ(moved.view().blocks[k].farthest, fresh.view().blocks[k].farthest);
    }
}

/// A ray that vanishes behind something and would meet the plane of what was behind it far beside that surface
/// meets nothing; near to it, it may go on there.
TEST(ImpostorSearch, GuessesNothingFarFromATriangle)
{
    Scene scene;
    int const matt = add_material(scene, lambert(vec3{0.5f}));
    add_quad(scene, {-1, -1, -4}, {3.6f, 0, 0}, {0, 2, 0}, matt);
    add_quad(scene, {0.6f, -1, -1}, {2.4f, 0, 0}, {0, 2, 0}, matt); // hides its right end
    World const world = world_of(scene);
    Impostors const impostors(world, {vec3{0}}, 128);
    auto const meets = [&](vec3 direction) {
        PathQuery query{.ray = {.ray = {{1, 0, -3.5f}, glm::normalize(direction)}}};
        Hit hit;
        ImpostorRays(world, impostors).nearest({&query, 1}, {&hit, 1});
        return hit.triangle != kNoTriangle;
    };
    EXPECT_FALSE(meets({1, 0, -0.05f})); // 8 m beside it
    EXPECT_TRUE(meets({1, 0, -0.33f}));
}

TEST(Impostors, RefuseWhatIsImpossible)
{
    World const world = box_room({-1, -1, -1}, {1, 1, 1});
    float const nan = std::numeric_limits<float>::quiet_NaN();
    EXPECT_THROW(Impostors(world, {{0, 0, 0}}, 12), InputError);
    EXPECT_THROW(Impostors(world, {{0, 0, 0}}, 0), InputError);
    EXPECT_THROW(Impostors(world, {{0, nan, 0}}, 16), InputError);
    EXPECT_THROW(Impostors(world, {{0, kInf, 0}}, 16), InputError);
    EXPECT_NO_THROW(Impostors(world, {}, 16));
}

} // namespace
} // namespace gi::test
