#include "gi/base/rng.h"
#include "gi/transport/exact_visibility.h"
#include "tests/support/scenes.h"

#include <gtest/gtest.h>

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

class MovingVisibility : public testing::TestWithParam<bool> {};

/// After a move, rays find what they find in a world that is new.
TEST_P(MovingVisibility, AnswersAsIfBuiltAnew)
{
    World world = world_at(0, GetParam());
    ExactVisibility moving(world, GetParam(), 1, kStays);
    for (float const t : {0.0f, 0.7f, 1.6f, 0.2f}) {
        World const now = world_at(t, GetParam());
        world.positions = now.positions; // of equal size: the view of `world` stays good
        moving.moved(world);
        ExactVisibility const anew(now, GetParam(), 1);
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
        EXPECT_GT(moved_hits, 100u);
    }
}

INSTANTIATE_TEST_SUITE_P(Holes, MovingVisibility, testing::Bool());

} // namespace
} // namespace gi::test
