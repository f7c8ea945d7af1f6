// Rooms in a world of 10 km: their light is right whatever surrounds them, while the camera walks out of the door.

#include "gi/methods/reference/reference.h"
#include "gi/metrics/ztest.h"
#include "gi/scene/model/sky.h"
#include "tests/slhb/slhb_render.h"
#include "tests/support/statistics.h"

#include <fmt/format.h>

namespace gi::test {
namespace {

constexpr float kWorld = 10'000; ///< m

/// Hills from the horizon to about the house, which stands on flat ground.
void add_terrain(Scene& scene)
{
    constexpr int kCells = 100;
    int const grass = add_material(scene, lambert({0.25f, 0.35f, 0.15f}));
    Mesh ground;
    ground.material = grass;
    for (int j = 0; j <= kCells; ++j)
        for (int i = 0; i <= kCells; ++i) {
            float const x = kWorld * (float(i) / kCells - 0.5f), z = kWorld * (float(j) / kCells - 0.5f);
            float const hills = 60 * (std::sin(x / 410) + std::sin(z / 530) + 2);
            ground.positions.emplace_back(x, hills * std::clamp((std::hypot(x, z) - 300) / 1000, 0.0f, 1.0f), z);
        }
    for (std::uint32_t j = 0; j < kCells; ++j)
        for (std::uint32_t i = 0; i < kCells; ++i) {
            std::uint32_t const here = j * (kCells + 1) + i, below = here + kCells + 1;
            ground.triangles.insert(ground.triangles.end(),
                                    {{here, below, here + 1}, {here + 1, below, below + 1}});
        }
    Node node;
    node.meshes = {int(scene.meshes.size())};
    scene.meshes.push_back(std::move(ground));
    scene.nodes.push_back(node);
}

/// 6 x 3 x 5 m, walls of 20 cm, two windows at -z, a door at +x, furniture.
void add_room(Scene& scene)
{
    int const wall = add_material(scene, lambert({0.75f, 0.72f, 0.68f}));
    int const wood = add_material(scene, lambert({0.45f, 0.28f, 0.15f}));
    int const cloth = add_material(scene, lambert({0.2f, 0.3f, 0.55f}));
    auto const block = [&](vec3 low, vec3 high, int material) { add_box(scene, low, high, material, false); };
    block({-3.2f, 0.001f, -2.7f}, {3.2f, 0.1f, 2.7f}, wood); // floor
    block({-3.2f, 3, -2.7f}, {3.2f, 3.2f, 2.7f}, wall);
    block({-3.2f, 0.1f, -2.7f}, {-3, 3, 2.7f}, wall);
    block({-3, 0.1f, 2.5f}, {3, 3, 2.7f}, wall);
    block({-3, 0.1f, -2.7f}, {3, 0.9f, -2.5f}, wall); // below and above windows, between them
    block({-3, 2.2f, -2.7f}, {3, 3, -2.5f}, wall);
    for (float const x : {-3.0f, -0.4f, 2.2f}) block({x, 0.9f, -2.7f}, {x + 0.8f, 2.2f, -2.5f}, wall);
    block({3, 0.1f, -2.7f}, {3.2f, 3, -0.5f}, wall); // beside and above the door
    block({3, 0.1f, 0.5f}, {3.2f, 3, 2.7f}, wall);
    block({3, 2.1f, -0.5f}, {3.2f, 3, 0.5f}, wall);
    block({-1.2f, 0.75f, -0.6f}, {0.6f, 0.8f, 0.4f}, wood); // table
    for (float const x : {-1.15f, 0.5f})
        for (float const z : {-0.55f, 0.3f}) block({x, 0.1f, z}, {x + 0.06f, 0.75f, z + 0.06f}, wood);
    for (float const z : {-1.2f, 0.7f}) { // chairs
        block({-0.5f, 0.5f, z}, {-0.05f, 0.54f, z + 0.45f}, cloth);
        block({-0.5f, 0.1f, z}, {-0.46f, 0.5f, z + 0.04f}, wood);
        block({-0.09f, 0.1f, z + 0.41f}, {-0.05f, 0.5f, z + 0.45f}, wood);
    }
    block({-2.9f, 0.1f, 1.6f}, {-0.9f, 0.55f, 2.4f}, cloth); // sofa, shelf
    block({-2.95f, 0.1f, -1.5f}, {-2.6f, 2, 0.2f}, wood);
}

World room_on_terrain()
{
    Scene scene;
    add_terrain(scene);
    add_room(scene);
    scene.environment = sky_map({.sun_elevation_deg = 35, .width = 256, .height = 128});
    return world_of(std::move(scene));
}

/// A terrain with a Cornell box of 1 m, open to the front and lit by its own lamp.
World box_on_terrain()
{
    Scene scene;
    add_terrain(scene);
    int const white = add_material(scene, lambert(vec3{0.73f}));
    add_quad(scene, {-0.5f, 0.01f, 0.5f}, {1, 0, 0}, {0, 0, -1}, white);
    add_quad(scene, {-0.5f, 1.01f, -0.5f}, {1, 0, 0}, {0, 0, 1}, white);
    add_quad(scene, {-0.5f, 0.01f, -0.5f}, {1, 0, 0}, {0, 1, 0}, white);
    add_quad(scene, {-0.5f, 0.01f, 0.5f}, {0, 0, -1}, {0, 1, 0},
             add_material(scene, lambert({0.6f, 0.06f, 0.05f})));
    add_quad(scene, {0.5f, 0.01f, -0.5f}, {0, 0, 1}, {0, 1, 0},
             add_material(scene, lambert({0.12f, 0.45f, 0.1f})));
    add_box(scene, {-0.3f, 0.01f, -0.3f}, {0, 0.6f, 0}, white, false);
    add_box(scene, {0.1f, 0.01f, 0}, {0.35f, 0.3f, 0.25f}, white, false);
    add_quad(scene, {-0.15f, 1, -0.15f}, {0.3f, 0, 0}, {0, 0, 0.3f}, add_material(scene, emitter(vec3{15})));
    return world_of(std::move(scene));
}

struct Light {
    RunningMean direct, indirect;

    void add(Picture const& p)
    {
        direct.add(mean_of(p, "L1").mean);
        indirect.add(mean_of(p, "L2").mean);
    }
};

/// Bias at default settings, with the standard error that is asked for.
void expect_no_bias(World const& world, Camera const& camera, std::string const& what, int seeds,
                    std::uint32_t paths)
{
    Light truth, found;
    double escaped = 0;
    for (int k = 0; k < seeds; ++k) {
        RenderSettings s = small_settings(48, 2 * paths, 3);
        s.seed = std::uint64_t(900 + k);
        StopRequest stop;
        Report lost;
        truth.add(render_reference(world, camera, s, stop, {}, lost).picture);
        s.paths = paths;
        s.seed = std::uint64_t(100 + k);
        SlhbRun const run = render_small(world, camera, s);
        found.add(run.result.picture);
        escaped += run.counts.at("hit-buffer queries");
    }
    EXPECT_EQ(escaped, 0) << "look-ups, whose texels are " << kWorld / 256 << " m wide";
    auto const judge = [&](RunningMean const& t, RunningMean const& f, char const* light) {
        double const sigma = std::hypot(t.sigma(), f.sigma()) / t.mean(), bias = f.mean() / t.mean() - 1;
        fmt::print("{}, {}: bias {:+.3f} % +- {:.3f}\n", what, light, 100 * bias, 100 * sigma);
        EXPECT_LT(std::abs(bias), 0.005 + 2 * sigma) << what << ", " << light;
        EXPECT_LT(sigma, 0.005) << "else the line before says little";
    };
    judge(truth.direct, found.direct, "direct");
    judge(truth.indirect, found.indirect, "indirect");
}

TEST(LargeWorld, CornellBox)
{
    expect_no_bias(box_on_terrain(), look_at({0, 0.5, 2.6}, {0, 0.5, 0}, 30), "box", 6, 128);
}

TEST(LargeWorld, FromTheRoomThroughTheDoor)
{
    World const world = room_on_terrain();
    for (double const x : {-2.2, 0.5, 2.4, 2.9, 3.4, 4.5})
        expect_no_bias(world, look_at({x, 1.6, 0.1 * x}, {x + 1, 1.4, -0.4 + 0.1 * x}, 60),
                       fmt::format("camera at {} m", x), 6, 192);
    expect_no_bias(world, look_at({9, 1.6, 2}, {1, 1.4, 0}, 50), "camera that looks back", 6, 192);
}

} // namespace
} // namespace gi::test
