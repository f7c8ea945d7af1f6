// The radiance cache: cells know what they were taught, and pictures of many passes keep their light but for a
// little blur, whatever moves, on any number of threads and at any size of the world.

#include "gi/hit_buffers/settings.h"
#include "gi/methods/paths/radiance_cache.h"

#include "gi/methods/slhb/slhb.h"
#include "gi/render/accumulator.h"
#include "gi/scene/generate/generate.h"
#include "tests/slhb/slhb_render.h"
#include "tests/support/scenes.h"

#include <tbb/global_control.h>

namespace gi::test {
namespace {

constexpr int kCachedSize = 64;

RenderSettings settings_of_cache()
{
    RenderSettings s = small_settings(kCachedSize, 1, 3);
    s.of<PathsSettings>().cache = RadianceCaching::on;
    return s;
}

struct Seen {
    Picture picture;
    double ended, cells; ///< paths that ended in cells, per pass
};

Seen see(MovingWorld const& world, Camera const& camera, VertexSharing sharing, std::uint32_t paths,
         RenderSettings const& s = settings_of_cache())
{
    Report report;
    FrameView const view{camera, kCachedSize, kCachedSize};
    auto result = start_frames_as_set(world, camera, s, report)->views({&view, 1}, paths, sharing, {});
    return {std::move(result[0].picture),
            report.counts().at("paths that ended in the radiance cache") / double(paths),
            report.counts().at("cells of the radiance cache")};
}

Camera in_box() { return look_at({-0.6, 0.1, 0.9}, {0.1, -0.4, 0}, 60); }

MovingWorld box()
{
    Report report;
    return {std::make_shared<Scene const>(box_with_block_and_lamp()), 0, report};
}

Surface floor_surface()
{
    Surface s{};
    s.edge1 = {1, 0, 0};
    s.edge2 = {0, 0, -1}; // up
    return s;
}

TEST(RadianceCache, CellsAreOfAPlaceASideAndAWidth)
{
    RadianceCache const cache(1, 1 << 20);
    Surface floor = floor_surface();
    vec3 const at{0.31f, 0, 0.32f}, down{0, -1, 0};
    auto const first = [&](vec3 p, vec3 arrival, float footprint, int further) {
        return cache.keys(floor, p, arrival, footprint, further).level[0];
    };
    std::uint64_t const here = first(at, down, 1, 2);
    EXPECT_EQ(here, first(at + vec3{1e-3f, 0, 0}, down, 1, 2));
    EXPECT_EQ(here, first(at, glm::normalize(vec3{1, -1, 0}), 1.1f, 2)) << "the same level, the same side";
    EXPECT_NE(here, first(at + vec3{2, 0, 0}, down, 1, 2));
    EXPECT_NE(here, first(at, -down, 1, 2)) << "the other side";
    EXPECT_NE(here, first(at, down, 4, 2)) << "another width";
    EXPECT_NE(here, first(at, down, 1, 1)) << "less light can follow";
    EXPECT_EQ(first(at, down, 1, 17), first(at, down, 1, 60));
    floor.material = 1;
    EXPECT_NE(here, first(at, down, 1, 2));
    floor.material = 0;
    std::swap(floor.edge1, floor.edge2);
    EXPECT_NE(here, first(at, down, 1, 2)) << "the bright inner side of a shade, which faces the same way";
}

TEST(RadianceCache, HasNoCellsWhereFloatsAreTooCoarse)
{
    RadianceCache const cache(1e7f, 1 << 20);
    Surface const floor = floor_surface();
    vec3 const down{0, -1, 0};
    EXPECT_TRUE(cache.keys(floor, vec3{100, 0, 0}, down, 10, 2).any());
    EXPECT_FALSE(cache.keys(floor, vec3{1e7f, 0, 0}, down, 1, 2).any());
    for (float const footprint : {0.0f, -1.0f, 1e-30f, float(kInf), std::nanf("")})
        EXPECT_FALSE(cache.keys(floor, vec3{100, 0, 0}, down, footprint, 2).any()) << footprint;
    EXPECT_FALSE(cache.keys(floor, vec3{std::nanf("")}, down, 1, 2).any());
}

TEST(RadianceCache, SaysTheWeightedMeanOfItsNotes)
{
    RadianceCache cache(1, 1 << 20);
    CacheKeys keys = cache.keys(floor_surface(), {0.3f, 0, 0.3f}, {0, -1, 0}, 1, 2);
    EXPECT_EQ(cache.find(keys).go_on, 1);
    CacheKeys taught = keys;
    std::fill(taught.level.begin() + 1, taught.level.end(), 0); // as find says for a place that is not known
    ASSERT_EQ(cache.find(keys).to_teach, 1u);
    std::vector<std::vector<CacheNote>> notes(2);
    for (int k = 0; k < 30; ++k) {
        notes[0].push_back({taught, vec3{1, 2, 3}, 1});
        notes[1].push_back({taught, vec3{4, 2, 0}, 2});
    }
    notes[0].push_back({taught, vec3{std::nanf("")}, 1}); // counts for nothing
    cache.learn(notes);
    CachedRadiance const known = cache.find(keys);
    EXPECT_LT(known.go_on, 0.3f);
    EXPECT_GT(known.go_on, 0);
    EXPECT_NEAR(known.radiance.x, 3, 1e-5f);
    EXPECT_NEAR(known.radiance.y, 2, 1e-5f);
    EXPECT_NEAR(known.radiance.z, 1, 1e-5f);
    cache.learn(notes);
    EXPECT_EQ(cache.find(keys).to_teach, 2u) << "with many notes, narrower cells are taught, too";
    notes[0] = {{taught, vec3{1}, 1, true}};
    cache.learn(std::span(notes).first(1));
    EXPECT_EQ(cache.find(keys).go_on, 1) << "one place in it sends on what depends on the direction";
    cache.clear();
    EXPECT_TRUE(cache.empty());
    EXPECT_EQ(cache.find(keys).go_on, 1);
}

TEST(RadianceCache, MorePathsTeachWhereNotesScatter)
{
    RadianceCache cache(1, 1 << 20);
    auto const go_on = [&](float x, float bright) { // with the same mean
        CacheKeys const keys = cache.keys(floor_surface(), {x, 0, 0.3f}, {0, -1, 0}, 1, 2);
        std::vector<std::vector<CacheNote>> notes(1);
        for (int k = 0; k < 1000; ++k) notes[0].push_back({keys, vec3{k % 100 < 100 / bright ? bright : 0}, 1});
        cache.learn(notes);
        return cache.find(keys).go_on;
    };
    float const even = go_on(0.3f, 1), uneven = go_on(10.3f, 10);
    EXPECT_LT(even, 0.1f);
    EXPECT_GT(uneven, 1.5f * even);
    EXPECT_LT(uneven, 0.5f);
    EXPECT_EQ(go_on(20.3f, 1e30f), go_on(30.3f, 0)) << "where squares overflow, or there is no light, as if even";
}

TEST(RadianceCache, StaysWithinItsMemoryAndCountsWhatItRefuses)
{
    RadianceCache cache(1, 1 << 21);
    std::vector<std::vector<CacheNote>> notes(1);
    for (int k = 0; k < 200'000; ++k)
        notes[0].push_back(
            {cache.keys(floor_surface(), {float(k % 500), 0, float(k) / 500}, {0, -1, 0}, 1, 2), vec3{1}, 1});
    cache.learn(notes);
    EXPECT_LE(cache.bytes(), std::size_t(1) << 21);
    EXPECT_GT(cache.cells(), 10'000u);
    EXPECT_GT(cache.refused(), 0u);
}

TEST(RadianceCache, MirrorsGlassAndMetalsAreDirectionalAndCoatsAreNot)
{
    Bsdf matt;
    EXPECT_FALSE(is_directional(matt));
    Bsdf coat = matt;
    coat.f0 = vec3{0.04f};
    coat.f90 = vec3{1};
    coat.alpha = 0.1f;
    EXPECT_FALSE(is_directional(coat));
    coat.alpha = 0;
    EXPECT_TRUE(is_directional(coat)) << "a mirror, if a weak one";
    Bsdf metal = matt;
    metal.f0 = metal.f90 = vec3{0.9f};
    metal.alpha = 0.1f;
    EXPECT_TRUE(is_directional(metal));
    metal.alpha = 0.5f;
    EXPECT_FALSE(is_directional(metal));
    Bsdf glass = matt;
    glass.clear = 1;
    EXPECT_TRUE(is_directional(glass));
}

void expect_same_light(Picture const& exact, Picture const& cached)
{
    EXPECT_NEAR(mean_of(cached).mean / mean_of(exact).mean, 1, 0.004);
    EXPECT_EQ(cached.find("L1")->data, exact.find("L1")->data) << "direct light is each pixel's own";
    // Where the light arrives, too: means of blocks of pixels, so that noise does not hide it.
    auto const blocks = [](Layer const& l) {
        constexpr int kAcross = 8;
        std::vector<double> sums(std::size_t(kAcross * kAcross));
        for (int y = 0; y < kCachedSize; ++y)
            for (int x = 0; x < kCachedSize; ++x)
                sums[std::size_t(y * kAcross / kCachedSize * kAcross + x * kAcross / kCachedSize)] +=
                    double(luminance(rgb(l, std::size_t(y * kCachedSize + x))));
        return sums;
    };
    auto const a = blocks(*exact.find("L2")), b = blocks(*cached.find("L2"));
    for (std::size_t k = 0; k < a.size(); ++k) EXPECT_NEAR(b[k], a[k], 0.05 * a[k] + 0.01) << k;
}

TEST(RadianceCache, BringsTheSameLightByRays)
{
    MovingWorld const world = box();
    Seen const exact = see(world, in_box(), VertexSharing::none, 200),
               cached = see(world, in_box(), VertexSharing::cached, 200);
    EXPECT_EQ(exact.ended, 0);
    EXPECT_GT(cached.ended, 0.3 * kCachedSize * kCachedSize);
    expect_same_light(exact.picture, cached.picture);
}

TEST(RadianceCache, BringsTheSameLightByLookUps)
{
    MovingWorld const world = box();
    RenderSettings s = settings_of_cache();
    s.of<SlhbSettings>().schedule = Schedule::stored;
    s.of<SlhbSettings>().directions = "icosahedron:320";
    s.of<SlhbSettings>().resolution = 64;
    s.of<SlhbSettings>().shadow_resolution = 64;
    Seen const exact = see(world, in_box(), VertexSharing::none, 256, s),
               cached = see(world, in_box(), VertexSharing::cached, 256, s);
    EXPECT_GT(cached.ended, 0.3 * kCachedSize * kCachedSize);
    expect_same_light(exact.picture, cached.picture);
}

/// A white ball and a white block under a sky that is the same everywhere: all of it has the radiance of the sky.
TEST(RadianceCache, KeepsTheFurnace)
{
    Scene scene;
    Material white = lambert(vec3{1});
    std::uint32_t const material = add_material(scene, white);
    add_sphere(scene, vec3{0}, 1, 4, material, false);
    add_sphere(scene, vec3{1.7f, 0, 0.3f}, 0.8f, 4, material, false);
    set_environment(scene, vec3{1});
    Report report;
    MovingWorld const world(std::make_shared<Scene const>(std::move(scene)), 0, report);
    RenderSettings s = settings_of_cache();
    s.bounces = 32;
    Seen const seen = see(world, look_at({0.9, 0.5, 4}, {0.8, 0, 0}, 40), VertexSharing::cached, 128, s);
    EXPECT_GT(seen.ended, 20); // most paths escape
    EXPECT_NEAR(mean_of(seen.picture).mean, 1, 0.003);
}

TEST(RadianceCache, DoesNotDependOnThreads)
{
    MovingWorld const world = box();
    auto const run = [&](std::size_t threads) {
        tbb::global_control const most(tbb::global_control::max_allowed_parallelism, threads);
        return see(world, in_box(), VertexSharing::cached, 3).picture.find("color")->data;
    };
    EXPECT_EQ(run(1), run(2));
}

/// Cells go with footprints: neither a huge nor a tiny world has more of them.
TEST(RadianceCache, CellsGoWithTheSizeOfTheWorld)
{
    Report report;
    std::vector<double> cells;
    for (float const scale : {1.0f, 1e-4f, 1e5f}) {
        Scene scene = box_with_block_and_lamp();
        for (Mesh& mesh : scene.meshes)
            for (vec3& p : mesh.positions) p *= scale;
        MovingWorld const world(std::make_shared<Scene const>(std::move(scene)), 0, report);
        Camera camera = in_box();
        camera.world_from_camera[3] = glm::dvec4(dvec3(camera.world_from_camera[3]) * double(scale), 1);
        cells.push_back(see(world, camera, VertexSharing::cached, 4).cells);
    }
    EXPECT_NEAR(cells[1] / cells[0], 1, 0.15);
    EXPECT_NEAR(cells[2] / cells[0], 1, 0.15);
}

TEST(RadianceCache, ChangesOfLightAreSeenAtOnce)
{
    MovingWorld const world = box();
    Report report;
    RenderSettings const s = settings_of_cache();
    FrameView const view{in_box(), kCachedSize, kCachedSize};
    auto const frames = start_frames_as_set(world, view.camera, s, report);
    auto const light = [&] { return frames->views({&view, 1}, 8, VertexSharing::cached, {})[0].picture; };
    light();
    double const before = report.counts().at("cells of the radiance cache");
    EXPECT_GT(before, 0);
    Changes changes;
    changes.lights = true;
    frames->changed(changes);
    frames->views({&view, 1}, 1, VertexSharing::none, {});
    EXPECT_EQ(report.counts().at("cells of the radiance cache"), 0);
}

/// The same picture by any path of frames: none begins with what another one has learnt.
TEST(RadianceCache, AFrameIsTheSameByItself)
{
    MovingWorld const world = box();
    RenderSettings s = settings_of_cache();
    s.paths = 2;
    auto const second = [&](int before) {
        Report report;
        auto const frames = start_frames_as_set(world, in_box(), s, report);
        for (int k = 0; k < before; ++k) frames->frame(in_box(), {}, {}, {});
        return report.counts()["paths that ended in the radiance cache"];
    };
    double const one = second(1);
    EXPECT_GT(one, 0);
    EXPECT_NEAR(second(2) / one, 2, 0.2) << "the second one starts anew";
}

TEST(RadianceCache, IsForPicturesThatTimeDecides)
{
    World const world = world_of(box_with_block_and_lamp());
    TriangleSoup const soup = make_soup(world);
    RenderSettings asked = small_settings(kCachedSize, 64, 3);
    auto const chosen = [&] { return choose_settings(asked, world, soup).of<PathsSettings>().cache; };
    EXPECT_EQ(chosen(), RadianceCaching::off);
    asked.budget_s = 1;
    EXPECT_EQ(chosen(), RadianceCaching::on);
    asked.of<PathsSettings>().cache = RadianceCaching::off;
    EXPECT_EQ(chosen(), RadianceCaching::off);
    asked.of<PathsSettings>().cache = RadianceCaching::on;
    asked.budget_s = 0;
    EXPECT_EQ(chosen(), RadianceCaching::on);
    asked.bounces = 0;
    EXPECT_EQ(chosen(), RadianceCaching::off);
}

} // namespace
} // namespace gi::test
