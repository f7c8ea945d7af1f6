// Scenes of any size: counts, sameness, refusal.

#include "gi/core/error.h"
#include "gi/scene/generate/generate.h"
#include "tests/scene/scene_checks.h"

namespace gi::test {
namespace {

constexpr std::size_t kRoom = 14; ///< triangles of the walls and the lamp

TEST(StressSets, BoxesAreCounted)
{
    for (std::uint32_t const n : {12u, 2004u, 99996u}) {
        Scene const scene = generate_boxes(n, 7);
        EXPECT_EQ(count_triangles(scene), n + kRoom);
        EXPECT_LE(scene.meshes.size(), 8u);
        EXPECT_EQ(scene.cameras.size(), 1u);
        expect_sound(scene);
    }
}

TEST(StressSets, SphereIsAboutAsLargeAsAsked)
{
    for (std::uint32_t const n : {12u, 2000u, 100000u}) {
        Scene const scene = generate_sphere(n, 7);
        EXPECT_NEAR(double(count_triangles(scene) - kRoom), n, 12 + 0.02 * n);
        expect_sound(scene);
    }
}

TEST(StressSets, EverythingIsInTheRoom)
{
    for (Scene const& scene : {generate_boxes(12000, 3), generate_sphere(12000, 3)})
        for (Mesh const& m : scene.meshes)
            for (vec3 const p : m.positions) {
                ASSERT_LE(std::max(std::abs(p.x), std::abs(p.z)), 5) << m.name;
                ASSERT_GE(p.y, 0);
                ASSERT_LE(p.y, 10);
            }
}

TEST(StressSets, SeedsDecide)
{
    EXPECT_EQ(hash(generate_boxes(6000, 5)), hash(generate_boxes(6000, 5)));
    EXPECT_NE(hash(generate_boxes(6000, 5)), hash(generate_boxes(6000, 6)));
    EXPECT_EQ(hash(generate_sphere(6000, 5)), hash(generate_sphere(6000, 5)));
    EXPECT_NE(hash(generate_sphere(6000, 5)), hash(generate_sphere(6000, 6)));
}

TEST(StressSets, AMillionTriangles)
{
    EXPECT_NEAR(double(count_triangles(generate_boxes(1'000'000, 1))), 1e6, 20);
    EXPECT_NEAR(double(count_triangles(generate_sphere(1'000'000, 1))), 1e6, 5e3);
}

TEST(StressSets, RefusesCountsOutOfRange)
{
    EXPECT_THROW(generate_boxes(11, 0), InputError);
    EXPECT_THROW(generate_sphere(0, 0), InputError);
    EXPECT_THROW(generate_boxes(200'000'001, 0), InputError);
    EXPECT_THROW(generate_sphere(0xffffffffu, 0), InputError);
}

} // namespace
} // namespace gi::test
