// A picture whose light is that of a quarter of its size is close to one whose light has its own size.

#include "gi/core/report.h"
#include "gi/hit_buffers/settings.h"
#include "gi/methods/registry.h"
#include "gi/metrics/flip.h"
#include "gi/scene/generate/generate.h"
#include "gi/surfaces/lit_picture.h"
#include "tests/surfaces/seen_picture.h"

#include <fmt/format.h>
#include <numeric>

namespace gi::test {
namespace {

double mean_flip(Picture const& a, Picture const& b)
{
    auto const shown = [](Picture const& p) {
        std::vector<float> v = p.find("color")->data;
        for (float& x : v) x = std::clamp(x, 0.0f, 1.0f);
        return v;
    };
    std::vector<float> const f = flip(shown(a), shown(b), a.width, a.height);
    return std::accumulate(f.begin(), f.end(), 0.0) / double(f.size());
}

/// Every pixel of the smaller picture, made larger.
Picture enlarged(Picture const& p, int times)
{
    Picture large{times * p.width, times * p.height, {}, {}};
    Layer& to = large.add("color", 3);
    for (int y = 0; y < large.height; ++y)
        for (int x = 0; x < large.width; ++x)
            for (std::size_t c = 0; c < 3; ++c)
                to.data[3 * std::size_t(y * large.width + x) + c] =
                    p.find("color")->data[3 * std::size_t(y / times * p.width + x / times) + c];
    return large;
}

Picture rendered(World const& world, Camera const& camera, int size, std::uint32_t paths)
{
    RenderSettings s;
    s.width = s.height = size;
    s.paths = paths;
    s.bounces = 3;
    s.of<SlhbSettings>().directions = "icosahedron:320";
    s.of<SlhbSettings>().resolution = 128;
    Report report;
    return find_method("slhb").render(world, camera, s, {}, {}, report).picture;
}

TEST(LitPicture, OfAQuarterOfTheLightIsNearTheFullOne)
{
    World const world = world_of(generate_cornell());
    Camera const camera = world.cameras.at(0);
    Picture const truth = rendered(world, camera, 160, 128), small = rendered(world, camera, 40, 256);
    SeenSurfaces seen(world, 0);
    seen.look(camera_rays(camera, 160, 160, world.origin), 160, 160);
    LitCounts counts;
    KeptLight const light(small, camera_rays(camera, 40, 40, world.origin), world.origin);
    Picture const lit = lit_picture(seen, 160, 160, light, {}, counts);
    LitCounts of_full;
    KeptLight const own(truth, camera_rays(camera, 160, 160, world.origin), world.origin);
    Picture const full = lit_picture(seen, 160, 160, own, {}, of_full); // with the same edges
    double const error = mean_flip(lit, full), smoothed = mean_flip(lit, truth),
                 stretched = mean_flip(enlarged(small, 4), truth);
    RecordProperty("flip",
                   fmt::format("{:.3f}, with smooth edges {:.3f}, stretched {:.3f}", error, smoothed, stretched));
    EXPECT_LT(error, 0.08); // measured: 0.066, 0.082 and 0.093
    EXPECT_LT(smoothed, 0.095);
    EXPECT_LT(smoothed, 0.95 * stretched); // although there are no textures
    EXPECT_GT(counts.surfaces, std::size_t(150 * 150));
    EXPECT_LT(counts.unlike, counts.surfaces / 100);
    for (float const v : lit.find("color")->data) ASSERT_TRUE(std::isfinite(v) && v >= 0);
}

TEST(LitPicture, HiddenPixelsStayBlack)
{
    World const world = world_of(generate_cornell());
    Camera const camera = world.cameras.at(0);
    Picture const small = rendered(world, camera, 8, 1);
    SeenSurfaces seen(world, 0);
    seen.look(camera_rays(camera, 16, 16, world.origin), 16, 16);
    std::vector<std::uint8_t> hidden(256);
    for (std::size_t i = 0; i < 128; ++i) hidden[i] = 1;
    LitCounts counts;
    KeptLight const light(small, camera_rays(camera, 8, 8, world.origin), world.origin);
    Picture const lit = lit_picture(seen, 16, 16, light, hidden, counts);
    EXPECT_LE(counts.surfaces, 128u);
    for (std::size_t i = 0; i < 128; ++i) {
        EXPECT_EQ(rgb(*lit.find("color"), i), vec3{0});
        EXPECT_EQ(lit.find("depth")->data[i], 0);
    }
}

/// What is said of mirror pixels meanwhile is undone, but for the depth of what they show.
TEST(LitPicture, MirrorsAreDescribedByWhatTheyShowAndBack)
{
    World const world = world_of(generate_mirror());
    Camera const camera = world.cameras.at(0);
    CameraRays const rays = camera_rays(camera, 40, 40, world.origin);
    Picture p = rendered(world, camera, 40, 1);
    p.add("motion", 3);
    Picture const before = p;
    SeenSurfaces seen(world, 0);
    seen.look(rays, 40, 40);
    MirrorLayers const was = describe_mirrored(seen, rays, rays, world.origin, p);
    ASSERT_GT(was.pixels.size(), 40u);
    std::size_t deeper = 0;
    for (std::uint32_t const i : was.pixels) {
        deeper += p.find("depth")->data[i] > before.find("depth")->data[i];
        vec3 const m = rgb(*p.find("motion"), i);
        EXPECT_NEAR(m.x, 0, 1e-3f); // nothing moves
        EXPECT_NEAR(m.y, 0, 1e-3f);
    }
    EXPECT_EQ(deeper, was.pixels.size());
    Picture described = p;
    describe_mirrors(was, p);
    for (char const* const layer : {"albedo", "normal", "position", "depth", "L1", "L2"})
        EXPECT_EQ(p.find(layer)->data, before.find(layer)->data) << layer;
    EXPECT_EQ(p.find("seen_depth")->data, described.find("depth")->data);
}

/// In its part it is as if all were looked at, and elsewhere as the picture of light.
TEST(LitPicture, APartOfItsMirrorsIsThatOfTheWhole)
{
    constexpr int kSize = 48, kOfLight = 24;
    World const world = world_of(generate_mirror());
    Camera const camera = world.cameras.at(0);
    CameraRays const rays = camera_rays(camera, kSize, kSize, world.origin);
    Picture const of_light = rendered(world, camera, kOfLight, 1);
    KeptLight const light(of_light, camera_rays(camera, kOfLight, kOfLight, world.origin), world.origin);
    auto const shown = [&](PixelBox const& part) {
        CameraRays own = rays;
        own.corner += float(part.low.x) * rays.step_x + float(part.low.y) * rays.step_y;
        SeenSurfaces seen(world, 0);
        seen.look_at_mirrors(own, part.high.x - part.low.x, part.high.y - part.low.y, SeenSurfaces::Lights::none);
        return mirror_picture(seen, part, kSize, kSize, light, of_light);
    };
    PixelBox const part{{7, 12}, {40, 35}};
    Picture const whole = shown({{0, 0}, {kSize, kSize}}), some = shown(part);
    std::size_t differ = 0, mirrored = 0;
    for (int y = 0; y < kSize; ++y)
        for (int x = 0; x < kSize; ++x) {
            std::size_t const i = std::size_t(y * kSize + x), j = std::size_t(y / 2 * kOfLight + x / 2);
            bool const inside = x >= part.low.x && y >= part.low.y && x < part.high.x && y < part.high.y;
            vec3 const expected = inside ? rgb(*whole.find("color"), i) : rgb(*of_light.find("color"), j);
            differ += glm::length(rgb(*some.find("color"), i) - expected) > 1e-3f;
            mirrored += inside && rgb(*whole.find("color"), i) != rgb(*of_light.find("color"), j);
        }
    EXPECT_LE(differ, 3u); // rays of a pixel at an edge may meet either surface
    EXPECT_GT(mirrored, 100u);
}

} // namespace
} // namespace gi::test
