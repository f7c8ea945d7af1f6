// What a query makes of surfaces that its columns meet from behind: insides of what is solid, and sheets.

#include "gi/core/rng.h"
#include "gi/hit_buffers/query_batch.h"
#include "tests/support/scenes.h"

#include <gtest/gtest.h>

namespace gi::test {
namespace {

/// 4 m x 4 m at height 0, the first triangles of the scene.
void add_floor(Scene& scene, int material) { add_quad(scene, {-2, 0, 2}, {4, 0, 0}, {0, 0, -4}, material); }

struct Walks {
    double hits = 0, count = 0, farthest_false_hit = 0; ///< texels from what they hit to where they start
};

/// Straight up from everywhere on the floor, in many grids; what they may meet
/// lies over a square about the middle.
Walks walk_up(Scene scene, float half_width, std::uint32_t resolution)
{
    World const world = world_of(std::move(scene));
    TriangleSoup const soup = make_soup(world);
    Pcg32 rng(8, 8);
    Walks w;
    for (int k = 0; k < 50; ++k) {
        vec2 const jitter = rng.uniform2();
        AxisPool pool;
        fill_pool(
            {make_hit_buffer(soup, make_grid(world.bounds, {0, 1, 0}, resolution, jitter, 6 * rng.uniform()))},
            pool);
        QueryBatch batch;
        batch.resize(2000);
        for (std::size_t i = 0; i < batch.size(); ++i) {
            vec2 const at = 3.0f * rng.uniform2() - 1.5f;
            batch.set(i, {{at.x, 0, at.y}, at.x + at.y > 0 ? 0u : 1u, true, true, 0}, 0);
        }
        nearest_layers(pool, world.surfaces, batch);
        for (std::size_t i = 0; i < batch.size(); ++i) {
            ++w.count;
            if (batch.hit[i] == kNoLayerHit) continue;
            ++w.hits;
            vec2 const off = glm::max(glm::abs(vec2{batch.x[i], batch.z[i]}) - half_width, 0.0f);
            w.farthest_false_hit = std::max(w.farthest_false_hit, double(glm::length(off) / pool.grids[0].texel));
        }
    }
    return w;
}

TEST(QueryBacks, AFloorThatGoesOnUnderAColumnIsNotDarkBesideIt)
{
    // The centre may lie under the column; the walk beside it must not meet the top from within.
    Scene scene;
    Material stone = lambert(vec3{0.5f});
    stone.double_sided = true;
    int const m = add_material(scene, stone);
    add_floor(scene, m);
    add_box(scene, {-0.3f, -0.1f, -0.3f}, {0.3f, 0.5f, 0.3f}, m, false);
    EXPECT_LE(walk_up(std::move(scene), 0.3f, 16).farthest_false_hit, 0.26); // kBackReach
}

TEST(QueryBacks, ASheetKeepsItsSizeFromBehind)
{
    for (bool const double_sided : {false, true}) {
        Scene scene;
        Material cloth = lambert(vec3{0.5f});
        cloth.double_sided = double_sided;
        int const m = add_material(scene, cloth);
        add_floor(scene, m);
        add_quad(scene, {-1, 0.5f, 1}, {2, 0, 0}, {0, 0, -2}, m); // faces up
        Walks const w = walk_up(std::move(scene), 1, 24);
        EXPECT_NEAR(w.hits / w.count, 4.0 / 9, 0.03 * 4 / 9) << double_sided;
    }
}

} // namespace
} // namespace gi::test
