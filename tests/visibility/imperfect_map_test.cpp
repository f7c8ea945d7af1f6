#include "gi/methods/vpl/imperfect_map.h"

#include "gi/core/rng.h"
#include "tests/support/scenes.h"

#include <gtest/gtest.h>

namespace gi::test {
namespace {

World room()
{
    Scene scene;
    add_box(scene, {-1, -1, -1}, {1, 1, 1}, add_material(scene, lambert(vec3{0.5f})), true);
    return world_of(scene);
}

LightVertex on_the_floor()
{
    LightVertex light{};
    light.position = {0.3f, -1, 0.2f};
    light.normal = {0, 1, 0};
    return light;
}

std::vector<float> draw(World const& world, LightVertex const& light, std::uint32_t points, std::uint32_t size)
{
    std::vector<float> map(std::size_t(size) * size), scratch;
    draw_imperfect_map(make_point_cloud(world, 1), {0, points}, light, {size}, map, scratch);
    return map;
}

/// From inside the room to its wall, in lengths of `way`.
float to_the_wall(vec3 from, vec3 way)
{
    float t = kInf;
    for (int k = 0; k < 3; ++k)
        if (way[k] != 0) t = std::min(t, ((way[k] > 0 ? 1.0f : -1.0f) - from[k]) / way[k]);
    return t;
}

TEST(HemisphereGrid, DirectionsOfTexelsAreInThem)
{
    HemisphereGrid const grid{64};
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x) {
            vec3 const d = grid.direction(x, y);
            EXPECT_NEAR(HemisphereGrid::octahedral_distance(d), 1, 1e-6f);
            vec2 const u = grid.square_from(3.0f * d);
            EXPECT_NEAR(u.x, float(x) + 0.5f, 1e-3f);
            EXPECT_NEAR(u.y, float(y) + 0.5f, 1e-3f);
        }
}

TEST(PointCloud, SubsetsAreSpreadOverTheArea)
{
    PointCloud const cloud = make_point_cloud(room(), 3);
    EXPECT_NEAR(cloud.area_m2, 24, 1e-4);
    for (std::uint32_t const first : {0u, 4096u, 65536u}) {
        int floor = 0;
        for (std::uint32_t i = first; i < first + 4096; ++i) {
            vec3 const p = cloud.position[i];
            EXPECT_NEAR(max_component(glm::abs(p)), 1, 1e-6f);
            floor += p.y < -0.9999f ? 1 : 0;
        }
        EXPECT_NEAR(floor, 4096 / 6.0, 2) << "its share of the area, nearly to the point";
    }
}

TEST(ImperfectMap, HasTheDistancesOfAConvexRoom)
{
    World const world = room();
    LightVertex const light = on_the_floor();
    Frame const frame = Frame::about(light.normal);
    for (auto const& [points, size, known, right] :
         {std::tuple{4096u, 64u, 0.97, 0.93}, std::tuple{131072u, 128u, 0.97, 0.97}}) {
        HemisphereGrid const grid{size};
        std::vector<float> const map = draw(world, light, points, size);
        std::size_t there = 0, true_distance = 0, too_near = 0;
        for (int y = 0; y < int(size); ++y)
            for (int x = 0; x < int(size); ++x) {
                float const truth = to_the_wall(light.position, frame.to_world(grid.direction(x, y)));
                float const t = map[std::size_t(y) * size + std::size_t(x)];
                there += t < kInf;
                true_distance += std::abs(t - truth) < 0.01f * truth;
                too_near += t < 0.98f * truth;
            }
        double const all = double(map.size());
        EXPECT_GT(double(there) / all, known) << points;
        EXPECT_GT(double(true_distance) / all, right) << points;
        EXPECT_LT(double(too_near) / all, 0.02) << points;
    }
}

/// A random point of the room's walls. @param normal  inwards
vec3 point_of_a_wall(Pcg32& rng, vec3& normal)
{
    int const axis = int(rng.uniform() * 3);
    float const side = rng.uniform() < 0.5f ? -1.0f : 1.0f;
    vec3 p{2 * rng.uniform() - 1, 2 * rng.uniform() - 1, 2 * rng.uniform() - 1};
    p[axis] = side;
    normal = vec3{0};
    normal[axis] = -side;
    return p;
}

TEST(ImperfectMap, LetsLightThroughAConvexRoom)
{
    World const world = room();
    PointCloud const cloud = make_point_cloud(world, 1);
    for (auto const& [points, size, most] : {std::tuple{1024u, 64u, 0.03}, std::tuple{131072u, 512u, 0.01}}) {
        HemisphereGrid const grid{size};
        std::vector<float> map(std::size_t(size) * size), scratch;
        Pcg32 rng(3, 4);
        int shadowed = 0, all = 0;
        for (int l = 0; l < 40; ++l) {
            LightVertex light{};
            light.position = point_of_a_wall(rng, light.normal);
            draw_imperfect_map(cloud, {0, points}, light, grid, map, scratch);
            MappedLight const mapped{light.position, Frame::about(light.normal), map.data()};
            for (int k = 0; k < 2000; ++k) {
                vec3 normal;
                vec3 const at = point_of_a_wall(rng, normal), way = light.position - at;
                if (glm::dot(way, normal) < 1e-5f || -glm::dot(way, light.normal) < 1e-5f) continue;
                ++all;
                shadowed += is_lit(mapped, grid, at, normal, 0.5f * cloud.disk_radius(points)) ? 0 : 1;
            }
        }
        EXPECT_LT(shadowed, most * all) << points << " points: " << shadowed << " of " << all;
    }
}

TEST(ImperfectMap, WithoutSurfacesNothingIsKnown)
{
    for (float const t : draw(world_of({}), on_the_floor(), 64, 16)) EXPECT_EQ(t, kInf);
}

} // namespace
} // namespace gi::test
