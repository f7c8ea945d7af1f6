// Several pictures of one moment: each is what it would be alone, and an eye that takes light from the other one
// has the same error for less work.

#include "gi/filter/reused_light.h"
#include "gi/hit_buffers/settings.h"
#include "gi/metrics/metrics.h"
#include "gi/render/accumulator.h"
#include "gi/scene/generate/generate.h"
#include "tests/slhb/slhb_render.h"
#include "tests/support/scenes.h"

#include <glm/gtc/matrix_transform.hpp>

namespace gi::test {
namespace {

std::shared_ptr<Scene const> view_room() { return std::make_shared<Scene const>(box_with_block_and_lamp()); }

/// @param aside  m to the right
Camera view_eye(double aside = 0)
{
    Camera camera = look_at({-0.6, 0.1, 0.9}, {0.1, -0.4, 0}, 60);
    camera.world_from_camera = camera.world_from_camera * glm::translate(dmat4(1), dvec3{aside, 0, 0});
    return camera;
}

RenderSettings settings_of_views(int bounces)
{
    RenderSettings s = small_settings(64, 1, bounces);
    s.of<SlhbSettings>().schedule = Schedule::stored;
    s.of<SlhbSettings>().directions = "icosahedron:80";
    s.of<SlhbSettings>().resolution = 64;
    return s;
}

std::vector<float> const& color(RenderResult const& r) { return r.picture.find("color")->data; }

double relmse_of(Layer const& a, Layer const& b) { return measure_errors(a.data, b.data, 3).relmse; }

/// Without bounces no endings are shared, so bits can be compared.
TEST(Views, AreThePicturesThatTheyWouldBeAlone)
{
    Report report;
    MovingWorld const world(view_room(), 0, report);
    RenderSettings s = settings_of_views(0);
    std::vector<FrameView> const all{{view_eye(), 64, 64}, {view_eye(0.5), 40, 56}, {view_eye(-0.2), 64, 30}};
    auto const together = start_frames_as_set(world, view_eye(), s, report)->views(all, 3, VertexSharing::exact, {});
    ASSERT_EQ(together.size(), 3u);
    for (std::size_t k = 0; k < all.size(); ++k) {
        auto const alone =
            start_frames_as_set(world, view_eye(), s, report)->views({&all[k], 1}, 3, VertexSharing::exact, {});
        EXPECT_EQ(color(together[k]), color(alone[0])) << k;
        EXPECT_EQ(together[k].picture.width, all[k].width);
    }
}

TEST(Views, CanBeSampledAtTheMiddlesOfPixels)
{
    Report report;
    MovingWorld const world(view_room(), 0, report);
    std::vector<FrameView> views{{view_eye(), 64, 64}};
    auto const depth_moves = [&] {
        auto const frames = start_frames_as_set(world, view_eye(), settings_of_views(0), report);
        std::vector<float> const
            first = frames->views(views, 1, VertexSharing::exact, {})[0].picture.find("depth")->data,
            second = frames->views(views, 1, VertexSharing::exact, {})[0].picture.find("depth")->data;
        return first != second;
    };
    EXPECT_TRUE(depth_moves());
    views[0].filter = PixelFilter::centre;
    EXPECT_FALSE(depth_moves());
}

/// The first view does not depend on what others take from it, and what they take is right: the mean of many
/// passes is that of paths of their own, but for half a pixel.
TEST(Views, LightTakenFromAPartnerIsTheLightThere)
{
    Report report;
    MovingWorld const world(view_room(), 0, report);
    RenderSettings const s = settings_of_views(2);
    double const apart = 0.063;
    std::vector<FrameView> const own{{view_eye(), 64, 64}, {view_eye(apart), 64, 64}};
    std::vector<FrameView> taking = own;
    taking[1].partner = 0;
    auto const a = start_frames_as_set(world, view_eye(), s, report)->views(own, 256, VertexSharing::exact, {});
    Report counted;
    auto const b = start_frames_as_set(world, view_eye(), s, counted)->views(taking, 256, VertexSharing::exact, {});
    double const share = counted.counts().at("share of pixels lit by a partner view");
    EXPECT_GT(share, 0.8);
    EXPECT_LT(share, 0.99); // what only the second eye sees is traced
    double const relmse = relmse_of(*b[1].picture.find("color"), *a[1].picture.find("color"));
    EXPECT_LT(relmse, 2e-3);
    double const bias = mean_of(b[1].picture).mean / mean_of(a[1].picture).mean;
    EXPECT_NEAR(bias, 1, 0.005);
}

/// A mirror shows each eye something else: nothing is taken there.
TEST(Views, MirrorsAreTracedForEachEye)
{
    Scene scene = box_with_block_and_lamp();
    add_quad(scene, {-0.9f, -0.9f, -0.95f}, {1.8f, 0, 0}, {0, 1.8f, 0}, add_material(scene, mirror(vec3{0.9f})));
    Report report;
    MovingWorld const world(std::make_shared<Scene const>(std::move(scene)), 0, report);
    RenderSettings s = settings_of_views(1);
    Camera const front = look_at({0, 0.3, 0.2}, {0, 0.3, -0.9}, 50), right = [&] {
        Camera c = front;
        c.world_from_camera = c.world_from_camera * glm::translate(dmat4(1), dvec3{0.06, 0, 0});
        return c;
    }();
    std::vector<FrameView> const own{{front, 48, 48}, {right, 48, 48}};
    std::vector<FrameView> taking = own;
    taking[1].partner = 0;
    auto const a = start_frames_as_set(world, front, s, report)->views(own, 4, VertexSharing::exact, {});
    auto const b = start_frames_as_set(world, front, s, report)->views(taking, 4, VertexSharing::exact, {});
    EXPECT_EQ(b[1].picture.find("L0")->data, a[1].picture.find("L0")->data);
    EXPECT_GT(relmse_of(*a[1].picture.find("color"), *a[0].picture.find("color")), 1e-3); // they do differ
}

/// Pixels that took light from the partner are listed for all paths of a frame; there, albedos and light agree.
TEST(Views, TellWhoseLightTheyTook)
{
    Report report;
    MovingWorld const world(view_room(), 0, report);
    RenderSettings const s = settings_of_views(1);
    std::vector<FrameView> const views{{view_eye(), 48, 40}, {view_eye(0.05), 64, 56, 0}};
    auto const frames = start_frames_as_set(world, view_eye(), s, report);
    std::size_t told_of_one = 0;
    for (std::uint32_t const paths : {1u, 6u}) {
        auto const results = frames->views(views, paths, VertexSharing::exact, {});
        EXPECT_TRUE(results[0].light_from.empty());
        ASSERT_EQ(results[1].light_from.size(), results[1].picture.pixels());
        std::size_t told = 0;
        double off_plane_m = 0;
        for (std::size_t i = 0; i < results[1].light_from.size(); ++i) {
            std::uint32_t const from = results[1].light_from[i];
            if (from == kOwnLight) continue;
            ASSERT_LT(from, results[0].picture.pixels());
            ++told;
            vec3 const here = rgb(*results[1].picture.find("position"), i),
                       there = rgb(*results[0].picture.find("position"), from);
            vec3 const normal = rgb(*results[1].picture.find("normal"), i);
            off_plane_m = std::max(off_plane_m, double(std::abs(glm::dot(here - there, normal))));
            if (paths > 1) continue;
            for (int c = 0; c < 3; ++c) {
                auto const light = [&](RenderResult const& r, std::size_t pixel) {
                    return rgb(*r.picture.find("L1"), pixel)[c] / rgb(*r.picture.find("albedo"), pixel)[c];
                };
                ASSERT_NEAR(light(results[1], i), light(results[0], from), 1e-4f * (1 + light(results[0], from)));
            }
        }
        EXPECT_GT(told, results[1].picture.pixels() / 2);
        EXPECT_LT(off_plane_m, paths == 1 ? 0.015 : 0.1); // a pixel of the partner's is 5 cm wide at most
        if (paths == 1)
            told_of_one = told;
        else
            EXPECT_LT(told, told_of_one); // at edges paths see different surfaces
    }
}

/// A view that changes its size, or returns after frames without it, starts without motion vectors.
TEST(Views, MayChangeFromFrameToFrame)
{
    Report report;
    MovingWorld const world(view_room(), 0, report);
    auto const frames = start_frames_as_set(world, view_eye(), settings_of_views(1), report);
    std::vector<FrameView> views{{view_eye(), 32, 32}, {view_eye(0.1), 32, 32, 0}};
    EXPECT_EQ(frames->views(views, 1, VertexSharing::exact, {}).size(), 2u);
    views[1].width = 20;
    views[1].camera = view_eye(0.3);
    auto const resized = frames->views(views, 1, VertexSharing::exact, {});
    EXPECT_EQ(resized[1].picture.pixels(), 640u);
    for (std::size_t i = 0; i < 640; ++i)
        if (vec3 const m = rgb(*resized[1].picture.find("motion"), i); m.z == m.z) {
            EXPECT_EQ(vec2(m), vec2(0));
        }
    views.pop_back();
    EXPECT_EQ(frames->views(views, 2, VertexSharing::exact, {}).size(), 1u);
    views.push_back({orthographic({0, 0.5, 0.8}, {0, 0, 0}, 1), 16, 16});
    EXPECT_EQ(frames->views(views, 1, VertexSharing::exact, {})[1].picture.width, 16);
}

} // namespace
} // namespace gi::test
