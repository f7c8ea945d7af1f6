// The method paths by kernels, on the host and on the device, against the CPU: with the same random numbers they trace
// the same paths, but for rounding.

#include "gi/core/error.h"
#include "gi/light_paths/settings.h"
#include "gi/methods/paths/kernels/kernel_cache.h"
#include "gi/methods/paths/kernels/kernel_frames.h"
#include "gi/methods/paths/kernels/kernel_render.h"
#include "gi/methods/paths/light_pool.h"
#include "gi/metrics/metrics.h"
#include "tests/slhb/kernel_rooms.h"
#include "tests/slhb/slhb_render.h"
#include "tests/support/on_device.h"

namespace gi::test {
namespace {

RenderSettings path_settings(std::uint32_t paths, int bounces)
{
    RenderSettings s = small_settings(32, paths, bounces);
    s.of<PhotonSettings>().caustic_paths = 0; // kernels trace none
    return s;
}

void expect_same_light(Picture const& found, Picture const& expected, std::string const& what)
{
    for (char const* const name : {"color", "L0", "L1", "L2", "albedo", "normal", "depth"}) {
        double const truth = mean_of(expected, name).mean;
        EXPECT_NEAR(mean_of(found, name).mean, truth, 0.002 * std::abs(truth) + 1e-4) << what << " " << name;
    }
    std::vector<float> const &a = found.find("color")->data, &b = expected.find("color")->data;
    ASSERT_EQ(a.size(), b.size());
    std::size_t differ = 0;
    for (std::size_t k = 0; k < a.size(); ++k) {
        ASSERT_TRUE(std::isfinite(a[k]));
        differ += std::abs(a[k] - b[k]) > 1e-3f * (std::abs(b[k]) + 0.01f);
    }
    EXPECT_LE(differ, a.size() / 100) << what;
}

template <Space S>
void expect_paths_of_cpu(Scene scene, RenderSettings const& settings, std::string const& what,
                         Camera const& camera = room_camera())
{
    World const world = world_of(std::move(scene));
    Report report, of_cpu;
    Picture const found = render_paths_by_kernels(S, world, camera, settings, {}, {}, report).picture;
    expect_same_light(found, render_paths(world, camera, settings, {}, {}, of_cpu).picture, what);
    EXPECT_EQ(report.losses().count("path terms that were not finite, dropped"), 0u) << what;
    for (char const* const rays : {"exact rays", "shadow rays"}) {
        double const expected = of_cpu.counts().count(rays) > 0 ? of_cpu.counts().at(rays) : 0;
        EXPECT_NEAR(report.counts().at(rays), expected, 0.01 * expected) << what << " " << rays;
    }
}

void add_lamp(Scene& scene)
{
    add_quad(scene, {-0.3f, 0.9f, -0.3f}, {0.6f, 0, 0}, {0, 0, 0.6f}, add_material(scene, emitter(vec3{10})));
}

template <Space S>
void check_paths_by_lights()
{
    Scene lamp = room();
    add_lamp(lamp);
    for (int const bounces : {0, 1, 6}) expect_paths_of_cpu<S>(lamp, path_settings(8, bounces), "lamp");
    RenderSettings ends_early = path_settings(8, 6);
    ends_early.of<PathsSettings>().roulette = 2;
    expect_paths_of_cpu<S>(lamp, ends_early, "lamp, roulette");

    Scene many = room(); // more than LightPool::kManyLights
    for (int k = 0; k < 600; ++k) {
        Light light;
        light.type = k % 3 == 2 ? LightType::spot : LightType::point;
        light.position = {0.9f * std::sin(float(k)), 0.8f, 0.9f * std::cos(1.7f * float(k))};
        light.direction = {0, -1, 0};
        light.intensity = vec3{0.01f * float(1 + k % 7)};
        add_light(many, light);
    }
    expect_paths_of_cpu<S>(many, path_settings(8, 3), "many lights");

    Scene open;
    add_quad(open, {-2, -1, -2}, {0, 0, 4}, {4, 0, 0}, add_material(open, lambert(vec3{0.5f})));
    add_sphere(open, {0, -0.4f, 0}, 0.6f, 3, add_material(open, rough_metal(0.6f)), false);
    set_environment(open, {1, 2, 3});
    Light sun;
    sun.type = LightType::directional;
    sun.direction = glm::normalize(vec3{0.3f, -1, 0.2f});
    add_light(open, sun);
    expect_paths_of_cpu<S>(open, path_settings(8, 3), "sky and sun");
    expect_paths_of_cpu<S>(Scene{}, path_settings(2, 2), "nothing");
    expect_paths_of_cpu<S>(room(), path_settings(2, 2), "no light");
}
LIGHTWELL_TEST_BOTH(KernelPaths, LightsAsByTheCpu, check_paths_by_lights);

template <Space S>
void check_paths_by_materials()
{
    Scene shiny = shiny_room();
    add_lamp(shiny);
    expect_paths_of_cpu<S>(shiny, path_settings(8, 4), "mirror, glass and metal");
    Light bulb;
    bulb.position = {0, 0.8f, 0.3f};
    bulb.intensity = vec3{2};
    Scene veiled = shiny_room();
    Material veil = lambert(vec3{0.9f});
    veil.alpha_mode = AlphaMode::blend;
    veil.alpha = 0.5f;
    add_quad(veiled, {-0.9f, 0.1f, -0.9f}, {0, 0, 1.8f}, {1.8f, 0, 0}, add_material(veiled, veil));
    add_light(veiled, bulb);
    expect_paths_of_cpu<S>(veiled, path_settings(8, 3), "half transparent veil");
    Scene pane = room();
    add_quad(pane, {-0.9f, 0.2f, -0.9f}, {0, 0, 1.8f}, {1.8f, 0, 0}, add_material(pane, glass(1.5f, true)));
    add_light(pane, bulb);
    expect_paths_of_cpu<S>(pane, path_settings(8, 3), "lamp behind a pane");
}
LIGHTWELL_TEST_BOTH(KernelPaths, MaterialsAsByTheCpu, check_paths_by_materials);

template <Space S>
void check_paths_by_lens()
{
    Scene lamp = room();
    add_lamp(lamp);
    Camera camera = room_camera();
    camera.aperture_radius_m = 0.1;
    camera.focus_distance_m = 2;
    expect_paths_of_cpu<S>(lamp, path_settings(8, 2), "lens", camera);
    RenderSettings tent = path_settings(8, 2);
    tent.filter = PixelFilter::tent;
    expect_paths_of_cpu<S>(lamp, tent, "tent filter");
}
LIGHTWELL_TEST_BOTH(KernelPaths, LensesAndFiltersAsByTheCpu, check_paths_by_lens);

template <Space S>
void check_frames_of_paths()
{
    Scene scene = shiny_room();
    add_lamp(scene);
    Report report, of_cpu;
    MovingWorld const moving(std::make_shared<Scene const>(std::move(scene)), 0, report);
    RenderSettings s = path_settings(3, 3);
    s.of<PathsSettings>().cache = RadianceCaching::off;
    s.of<PathsSettings>().interleave = 1;
    Camera const left = room_camera();
    Camera right = left;
    right.world_from_camera[3] += 0.06 * left.world_from_camera[0];
    std::vector<std::uint8_t> hidden(std::size_t(32 * 32), 0);
    std::fill_n(hidden.begin(), 100, std::uint8_t(1));
    std::vector<FrameView> views{{left, 32, 32}, {right, 24, 32}};
    views[0].hidden = hidden;
    auto const kernels = start_path_kernel_frames(S, moving, left, s, report);
    auto const cpu = start_path_frames(moving, left, s, of_cpu);
    for (int frame = 0; frame < 2; ++frame) {
        auto const found = kernels->views(views, 3, VertexSharing::none, {});
        auto const expected = cpu->views(views, 3, VertexSharing::none, {});
        ASSERT_EQ(found.size(), 2u);
        for (std::size_t k = 0; k < 2; ++k) {
            EXPECT_EQ(found[k].paths, 3u);
            expect_same_light(found[k].picture, expected[k].picture, "view " + std::to_string(k));
        }
    }
}
LIGHTWELL_TEST_BOTH(KernelPaths, FramesOfTwoEyesAsByTheCpu, check_frames_of_paths);

template <Space S>
void check_paths_to_cells()
{
    Scene scene = shiny_room();
    add_lamp(scene);
    World const world = world_of(std::move(scene));
    RenderSettings s = path_settings(24, 6);
    s.of<PathsSettings>().cache = RadianceCaching::on;
    Report report, of_cpu, again;
    auto const found = render_paths_by_kernels(S, world, room_camera(), s, {}, {}, report);
    Picture const expected = render_paths(world, room_camera(), s, {}, {}, of_cpu).picture;
    double const reads = of_cpu.counts().at("paths that ended in the radiance cache");
    EXPECT_GT(reads, 1000);
    EXPECT_NEAR(report.counts().at("paths that ended in the radiance cache"), reads, 0.02 * reads);
    double const cells = of_cpu.counts().at("cells of the radiance cache");
    EXPECT_NEAR(report.counts().at("cells of the radiance cache"), cells, 0.02 * cells);
    for (char const* const name : {"color", "L1", "L2"}) {
        double const truth = mean_of(expected, name).mean;
        EXPECT_NEAR(mean_of(found.picture, name).mean, truth, 0.005 * truth) << name;
    }
    std::vector<float> const &a = found.picture.find("color")->data, &b = expected.find("color")->data;
    std::size_t differ = 0;
    for (std::size_t k = 0; k < a.size(); ++k) differ += std::abs(a[k] - b[k]) > 0.02f * (std::abs(b[k]) + 0.01f);
    EXPECT_LE(differ, a.size() / 20);
    // Integer sums are the same whatever the order of threads.
    auto const second = render_paths_by_kernels(S, world, room_camera(), s, {}, {}, again);
    EXPECT_EQ(second.picture.find("color")->data, found.picture.find("color")->data);
}
LIGHTWELL_TEST_BOTH(KernelPaths, CellsAsByTheCpuAndTheSameBitsTwice, check_paths_to_cells);

template <Space S>
void check_cells_that_grow()
{
    KernelCache<S> cache(1, std::size_t(1) << 30, 1000);
    constexpr std::uint32_t kNotes = 400'000;
    CacheView const view = cache.lend(kNotes);
    std::vector<PathSample> samples(1);
    samples[0].radiance[2] = vec3{2, 4, 8};
    Buffer<PathSample, S> const there = upload<S>(samples);
    std::vector<std::uint32_t> words(3 * std::size_t(kNotes) * (sizeof(CacheNoteOnWay) / 4));
    ColumnView<CacheNoteOnWay> const on_host{words, 3 * std::size_t(kNotes)};
    auto const key_of = [](std::uint64_t k) { return mix_bits(k / 2) | 1; }; // two notes each
    for (std::uint32_t k = 0; k < kNotes; ++k) {
        CacheNoteOnWay note{};
        note.set_key(0, key_of(k));
        note.throughput = vec3{2};
        note.before = vec3{0, 0, k % 2 == 0 ? 0.0f : 4.0f};
        note.weight = 0.5f;
        note.directional = k >= kNotes - 2 ? 1 : 0;
        on_host.store(k, note);
    }
    copy_bytes(S, view.notes.words.data, Space::host, words.data(), words.size() * sizeof(std::uint32_t));
    std::uint32_t const count = kNotes;
    copy_bytes(S, view.count.data, Space::host, &count, sizeof(count));
    EXPECT_TRUE(cache.empty());
    cache.learn(there.view());
    EXPECT_FALSE(cache.empty());
    std::size_t const bytes = cache.bytes();
    cache.grow();
    EXPECT_EQ(cache.cells(), kNotes / 2);
    EXPECT_EQ(cache.refused(), 0u);
    EXPECT_GT(cache.bytes(), bytes);
    CacheView after = cache.lend(kNotes);
    std::vector<CacheCell> cells(after.cells.size());
    copy_bytes(Space::host, cells.data(), S, after.cells.data, cells.size() * sizeof(CacheCell));
    after.cells = cells;
    for (std::uint32_t k = 0; k < kNotes; k += 1000) {
        CellSums const sums = after.sums_of(key_of(k));
        ASSERT_EQ(sums.notes, 2);
        EXPECT_NEAR(sums.weight, 1, 1e-5);
        EXPECT_NEAR(sums.radiance.x, 1, 1e-4);
        EXPECT_NEAR(sums.radiance.z, 3, 1e-4); // (8 + 4) / 2 over two
    }
    EXPECT_LT(after.sums_of(key_of(kNotes - 1)).notes, 0);
    EXPECT_EQ(after.sums_of(key_of(kNotes + 1)).notes, 0);
    cache.clear();
    EXPECT_TRUE(cache.empty());
}
LIGHTWELL_TEST_BOTH(KernelPaths, CellsGrowAndKeepTheirSums, check_cells_that_grow);

TEST(KernelPaths, ThePoolChoosesTheSameLights)
{
    Scene scene = room();
    add_lamp(scene);
    for (int k = 0; k < 700; ++k) {
        Light light;
        light.position = {std::sin(float(k)), 0.5f, std::cos(float(k))};
        light.intensity = vec3{1 + float(k % 5)};
        add_light(scene, light);
    }
    World const world = world_of(std::move(scene));
    LightOrder order;
    order.update(world);
    LightPool pool;
    pool.fill(order, world, 64, 3, 0);
    ASSERT_GT(pool.rounds(), 1u);
    LightPoolView const view{pool.groups(), pool.lights(), pool.rounds()};
    Pcg32 rng(5, 1);
    for (int k = 0; k < 10000; ++k) {
        vec3 const at = 2.0f * vec3{rng.uniform(), rng.uniform(), rng.uniform()} - 1.0f,
                   normal = glm::normalize(vec3{rng.uniform() - 0.5f, rng.uniform() - 0.5f, rng.uniform() - 0.5f});
        float const u = rng.uniform(), pick = rng.uniform();
        ChosenLight const expected = pool.choose(at, normal, u, pick), found = view.choose(at, normal, u, pick);
        ASSERT_EQ(found.light, expected.light);
        ASSERT_EQ(found.weight, expected.weight);
    }
}

} // namespace
} // namespace gi::test
