#include "gi/core/rng.h"
#include "gi/render/exact_visibility.h"
#include "gi/render/world_bvh.h"
#include "tests/support/scenes.h"

#include <gtest/gtest.h>
#include <limits>

namespace gi::test {
namespace {

constexpr std::size_t kStays = 12; // the triangles of the room

/// A room with a ball and a grating (half of its light goes through, if asked) that move.
World world_at(float t, bool holes)
{
    Scene scene;
    Material half = lambert(vec3{0.5f});
    if (holes) {
        half.alpha_mode = AlphaMode::blend;
        half.alpha = 0.5f;
    }
    int const walls = add_material(scene, lambert(vec3{0.5f})), moving = add_material(scene, half);
    add_box(scene, {-2, -2, -2}, {2, 2, 2}, walls, true);
    add_sphere(scene, {t - 1, 0.3f, 0.5f * t}, 0.5f, 3, walls, false);
    add_quad(scene, {-1, -1.5f, -1 + t}, {2, 0, 0}, {0, 1, 0}, moving);
    return world_of(scene);
}

struct Embree {
    ExactVisibility visibility;
    Embree(World const& world, bool holes) : visibility(world, holes, 1, kStays) {}
};
/// The rays of kernels, one at a time.
struct OwnBvh {
    struct Visibility {
        WorldView world;
        WorldBvh<Space::host> bvh;

        void moved(World const& now)
        {
            world = view(now);
            bvh.moved(world);
        }
        void nearest(std::span<RayQuery const> queries, std::span<Hit> hits) const
        {
            for (std::size_t i = 0; i < queries.size(); ++i) hits[i] = bvh.rays().nearest(world, queries[i]);
        }
        void occluded(std::span<RayQuery const> queries, std::span<std::uint8_t> blocked) const
        {
            for (std::size_t i = 0; i < queries.size(); ++i) blocked[i] = bvh.rays().occluded(world, queries[i]);
        }
    } visibility;
    OwnBvh(World const& world, bool holes) : visibility{view(world), {view(world), holes, kStays}} {}
};

template <class Rays>
class MovingVisibility : public testing::Test {
};
using AllRays = testing::Types<Embree, OwnBvh>;
TYPED_TEST_SUITE(MovingVisibility, AllRays);

/// Do rays find in `moving` what they find in `now`? @return how many of them hit what moves
template <class Visibility>
std::size_t expect_equal(Visibility const& moving, World const& now, bool holes)
{
    ExactVisibility const anew(now, holes, 1);
    Pcg32 rng(4, 4);
    std::vector<RayQuery> rays(10000);
    for (RayQuery& r : rays) {
        vec3 const d{rng.uniform() - 0.5f, rng.uniform() - 0.5f, rng.uniform() - 0.5f};
        r = {.ray = {1.8f * vec3{rng.uniform(), rng.uniform(), rng.uniform()}, glm::normalize(d)},
             .reach = 3,
             .seed = rng.next()};
    }
    std::vector<Hit> one(rays.size()), other(rays.size());
    moving.nearest(rays, one);
    anew.nearest(rays, other);
    std::vector<std::uint8_t> blocked(rays.size()), expected(rays.size());
    moving.occluded(rays, blocked);
    anew.occluded(rays, expected);
    std::size_t moved_hits = 0, differ = 0;
    for (std::size_t k = 0; k < rays.size(); ++k) {
        differ += one[k].triangle != other[k].triangle || blocked[k] != expected[k];
        moved_hits += one[k].triangle != kNoTriangle && one[k].triangle >= kStays;
    }
    EXPECT_LE(differ, 4u); // rays through edges
    return moved_hits;
}

/// After a move, rays find what they find in a world that is new.
TYPED_TEST(MovingVisibility, AnswersAsIfBuiltAnew)
{
    for (bool const holes : {false, true}) {
        World world = world_at(0, holes);
        TypeParam rays(world, holes);
        for (float const t : {0.0f, 0.7f, 1.6f, 0.2f}) {
            World const now = world_at(t, holes);
            world.positions = now.positions; // of equal size: the view of `world` stays good
            rays.visibility.moved(world);
            EXPECT_GT(expect_equal(rays.visibility, now, holes), 100u);
        }
    }
}

/// What collapses, or is nowhere for a while, comes back; also where it began so.
TYPED_TEST(MovingVisibility, UnusableVerticesLeaveAndComeBack)
{
    float const nan = std::numeric_limits<float>::quiet_NaN();
    for (bool const holes : {false, true})
        for (float const away : {0.0f, 1.0f, nan, kInf, 1e20f})
            for (bool const away_at_first : {false, true}) {
                World world = world_at(0.5f, holes);
                World const now = world_at(0.5f, holes);
                auto const send_away = [&] {
                    // All to one place, else triangles would lie in each other.
                    std::size_t const step = std::abs(away) <= 1 ? 1 : 2;
                    for (std::size_t i = world.triangles[kStays].x; i < world.positions.size(); i += step)
                        world.positions[i] = vec3{away};
                };
                if (away_at_first) send_away();
                TypeParam rays(world, holes);
                send_away();
                rays.visibility.moved(world);
                expect_equal(rays.visibility, world, holes);
                world.positions = now.positions;
                rays.visibility.moved(world);
                EXPECT_GT(expect_equal(rays.visibility, now, holes), 100u) << away;
            }
}

} // namespace
} // namespace gi::test
