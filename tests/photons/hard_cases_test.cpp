// Scenes and settings that could break the photon methods: each becomes a picture of finite numbers or is refused.

#include "gi/core/error.h"
#include "gi/methods/sh_grid/settings.h"
#include "gi/methods/sh_grid/sh_grid.h"
#include "tests/photons/photon_methods.h"
#include "tests/support/stop_at_ask.h"

#include <algorithm>
#include <fmt/format.h>
#include <gtest/gtest.h>

namespace gi::test {
namespace {

Picture picture_of(PhotonMethod const& m, Scene const& scene, Camera const& camera, RenderSettings const& s)
{
    Report report;
    Picture p = m.render(world_of(scene), camera, s, {}, {}, report).picture;
    for (Layer const& layer : p.layers) {
        bool const finite = std::ranges::all_of(layer.data, [](float v) { return std::isfinite(v); });
        EXPECT_TRUE(finite) << m.name << ", " << layer.name;
    }
    return p;
}

Light point_light(vec3 position, float intensity = 1)
{
    Light lamp;
    lamp.type = LightType::point;
    lamp.position = position;
    lamp.intensity = vec3{intensity};
    return lamp;
}

TEST(PhotonMethods, NothingToSeeOrNoLightIsDark)
{
    Camera const camera = look_at({0, 0, 3}, {0, 0, 0}, 60);
    for (PhotonMethod const& m : kPhotonMethods)
        for (bool const lit : {false, true})
            for (bool const surface : {false, true}) {
                if (lit && surface) continue;
                Scene scene;
                if (surface)
                    add_quad(scene, {-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, add_material(scene, lambert(vec3{0.5f})));
                if (lit) add_light(scene, point_light({0, 0, 1}));
                Picture const p = picture_of(m, scene, camera, small_photon_picture(8, 256));
                EXPECT_EQ(mean_of(p).mean, 0) << m.name;
            }
}

/// A single light path, from below the floor or from far away: no indirect light and no harm.
TEST(PhotonMethods, OneLightPath)
{
    for (PhotonMethod const& m : kPhotonMethods)
        for (vec3 const lamp : {vec3{0, -5, 0}, vec3{0, 1e6f, 0}}) {
            Scene scene;
            add_quad(scene, {-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, add_material(scene, lambert(vec3{0.5f})));
            add_light(scene, point_light(lamp));
            Picture const p = picture_of(m, scene, look_at({0, 1, 2}, {0, 0, 0}, 60), small_photon_picture(16, 1));
            EXPECT_EQ(indirect(p), 0) << m.name;
        }
}

/// One triangle, lit from the front: all that it reflects leaves. In a lattice in which light
/// propagates a little comes back to it.
TEST(PhotonMethods, OneTriangle)
{
    Scene scene;
    add_quad(scene, {-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, add_material(scene, lambert(vec3{0.8f})));
    scene.meshes.back().triangles.resize(1);
    add_light(scene, point_light({0.2f, -0.2f, 1}));
    for (PhotonMethod const& m : kPhotonMethods) {
        Picture const p = picture_of(m, scene, look_at({0, 0, 3}, {0, 0, 0}, 60), small_photon_picture(16, 4096));
        double const direct = mean_of(p, "L1").mean;
        EXPECT_GT(direct, 0) << m.name;
        EXPECT_LE(indirect(p), (m.start == start_lpv_frames ? 0.05 : 1e-3) * direct) << m.name;
    }
}

/// Light stays on its side of the walls of a closed box, which have no thickness. Of photons in cells the outer
/// sides of walls take, near edges, what the other walls in the cell get: here in a tenth of a wall's width.
TEST(PhotonMethods, ClosedBox)
{
    vec3 const inside{0.1f, 0.2f, 0.3f}, outside{0.2f, 0.1f, 3}, far{1e4f, 0, 0};
    Camera const in = look_at({-0.5, 0.2, 0.8}, {0.2, -0.3, -1}, 80), out = look_at({0.5, 1, 4}, {0, 0, 0}, 50);
    auto const scene_with = [](Light const& lamp) {
        Scene scene;
        int const wall = add_material(scene, lambert(vec3{0.6f}));
        scene.materials.back().double_sided = true;
        add_box(scene, vec3{-1}, vec3{1}, wall, true);
        add_light(scene, lamp);
        return scene;
    };
    for (PhotonMethod const& m : kPhotonMethods) {
        RenderSettings const s = small_photon_picture(16, 16384);
        double const lit = indirect(picture_of(m, scene_with(point_light(inside)), in, s));
        EXPECT_GT(lit, 0) << m.name;
        double const from_outside = indirect(picture_of(m, scene_with(point_light(inside)), out, s)) / lit,
                     lamp_outside = indirect(picture_of(m, scene_with(point_light(outside, 10)), in, s)) / lit,
                     lamp_far = indirect(picture_of(m, scene_with(point_light(far, 1e8f)), in, s)) / lit;
        fmt::print("{}: seen from outside {:.4f}, light outside {:.4f}, far outside {:.4f} of that inside\n",
                   m.name, from_outside, lamp_outside, lamp_far);
        double const known = m.start == start_isllpm_frames        ? 0.25
                             : m.start == start_multi_image_frames ? 0.3
                                                                   : 0.01;
        EXPECT_LT(from_outside, known) << m.name;
        for (double const leak : {lamp_outside, lamp_far}) EXPECT_LT(leak, 0.01) << m.name;
    }
}

/// The same picture at any scale, mirror and caustics too.
TEST(PhotonMethods, AnyScale)
{
    for (PhotonMethod const& m : kPhotonMethods) {
        RenderSettings const s = small_photon_picture(16, 8192);
        Picture const one = picture_of(m, room_with_mirror(), in_the_room(), s);
        for (float const scale : {1e-3f, 1e5f}) {
            Picture const other = picture_of(m, room_with_mirror(scale), in_the_room(double(scale)), s);
            for (char const* const layer : {"L1", "L2"}) {
                std::vector<float> const &a = one.find(layer)->data, &b = other.find(layer)->data;
                double off = 0, sum = 0;
                for (std::size_t i = 0; i < a.size(); ++i) {
                    off += std::abs(double(a[i] - b[i]));
                    sum += double(a[i]);
                }
                fmt::print("{}, {} at {:g} m: off by {:.5f}\n", m.name, layer, double(scale), off / sum);
                EXPECT_LT(off / sum, 0.02) << m.name << ", " << layer << " at " << scale;
            }
        }
    }
}

/// Two equal floors at the same place are one.
TEST(PhotonMethods, CoplanarSurfaces)
{
    for (PhotonMethod const& m : kPhotonMethods) {
        double light[2];
        for (int const floors : {1, 2}) {
            Scene scene;
            int const matt = add_material(scene, lambert(vec3{0.7f}));
            for (int k = 0; k < floors; ++k) add_quad(scene, {-1, 0, -1}, {0, 0, 2}, {2, 0, 0}, matt);
            add_quad(scene, {-1, 0, -1}, {2, 0, 0}, {0, 2, 0}, matt);
            add_light(scene, point_light({0.2f, 1, 0.2f}));
            light[floors - 1] = indirect(
                picture_of(m, scene, look_at({0, 1, 3}, {0, 0.5, 0}, 50), small_photon_picture(16, 16384)));
        }
        fmt::print("{}: two floors {:.4f} of one\n", m.name, light[1] / light[0]);
        EXPECT_GT(light[0], 0);
        EXPECT_NEAR(light[1] / light[0], 1, 0.05) << m.name;
    }
}

/// Memory is refused before it is spent.
TEST(PhotonMethods, PhotonsLatticesAndImpostorsBeyondMemory)
{
    World const world = world_of(room_with_mirror());
    auto const refused = [&](char const* name, RenderSettings const& s) {
        std::vector<PhotonMethod> methods(std::begin(kPhotonMethods), std::end(kPhotonMethods));
        methods.push_back({"sh_grid", render_sh_grid, start_sh_grid_frames});
        for (PhotonMethod const& m : methods) {
            if (std::string(m.name) != name) continue;
            Report report;
            try {
                m.render(world, in_the_room(), s, {}, {}, report);
                ADD_FAILURE() << name << " took it";
            } catch (InputError const& e) {
                EXPECT_NE(std::string(e.what()).find("GiB"), std::string::npos) << e.what();
            }
        }
    };
    RenderSettings s = small_photon_picture(8, 256);
    s.of<PhotonSettings>().impostors = 256;
    s.of<PhotonSettings>().impostor_texels = 2048;
    refused("multi_image", s);
    s.of<PhotonSettings>().rays = PhotonRays::impostors;
    for (char const* const name : {"ispm", "lpv", "isllpm", "sh_grid"}) refused(name, s);
    s.of<PhotonSettings>().impostors = 1;
    for (int k = 0; k < 256; ++k)
        s.of<PhotonSettings>().impostor_places += (k > 0 ? ";0,0.01," : "0,0.01,") + std::to_string(k);
    for (char const* const name : {"ispm", "lpv", "isllpm", "multi_image"}) refused(name, s);
    s.of<PhotonSettings>().impostor_places.clear();
    s = small_photon_picture(8, PhotonSettings::kMostPaths);
    for (FirstBounce const first : {FirstBounce::rays, FirstBounce::map}) {
        s.of<PhotonSettings>().first_bounce = first;
        for (char const* const name : {"ispm", "lpv", "isllpm", "multi_image"}) refused(name, s);
    }
    s = small_photon_picture(8, 256);
    s.of<PhotonSettings>().low_cells = s.of<PhotonSettings>().middle_cells = s.of<PhotonSettings>().high_cells = 512;
    s.of<PhotonSettings>().lattice_cascades = 4;
    refused("isllpm", s);
}

/// Renders until the stop is obeyed. @returns whether there is no picture
bool is_interrupted(PhotonMethod const& m, World const& world, RenderSettings const& s, StopRequest const& stop)
{
    Report report;
    try {
        m.render(world, in_the_room(), s, stop, {}, report);
    } catch (Interrupted const&) {
        return true;
    }
    return false;
}

/// How often a whole render asks whether to stop, at least: by one thread, since work that threads share is cut by
/// chance into more pieces, and each piece asks.
std::uint64_t asks_of(PhotonMethod const& m, World const& world, RenderSettings const& s)
{
    tbb::global_control const one_thread(tbb::global_control::max_allowed_parallelism, 1);
    StopAtAsk never;
    EXPECT_FALSE(is_interrupted(m, world, s, never));
    return never.asks();
}

/// A stop at any share of the asks of a first picture is obeyed at the next of every thread.
void expect_stops(PhotonMethod const& m, World const& world, RenderSettings const& s, std::uint64_t asks)
{
    for (double const share : {0.02, 0.25, 0.5, 0.9}) {
        auto const ask = std::uint64_t(share * double(asks)) + 1;
        StopAtAsk stop(ask);
        EXPECT_TRUE(is_interrupted(m, world, s, stop)) << m.name << " at " << share;
        EXPECT_LE(stop.asks(), ask + asks_until_noticed()) << m.name << " at " << share;
    }
}

/// While light paths are traced, a stop is asked for with every 64 of them.
TEST(PhotonStops, WhileLightPathsAreTraced)
{
    World const world = world_of(room_with_mirror());
    constexpr int kPaths = 16384;
    for (PhotonMethod const& m : kPhotonMethods) {
        RenderSettings const s = small_photon_picture(8, kPaths);
        std::uint64_t const asks = asks_of(m, world, s);
        EXPECT_GE(asks, std::uint64_t(kPaths / 64)) << m.name;
        expect_stops(m, world, s, asks);
    }
}

/// Stages after tracing are as long as cells and steps are many: a stop is obeyed in them, too.
TEST(PhotonStops, AfterTracing)
{
    World const world = world_of(room_with_mirror());
    struct Stage {
        char const* method;
        RenderSettings without, with; ///< few asks and many in the stage
    };
    std::vector<Stage> stages;
    RenderSettings s = small_photon_picture(8, 4096);
    s.of<PhotonSettings>().caustic_paths = 0;
    RenderSettings lattices = s;
    lattices.of<PhotonSettings>().low_cells = lattices.of<PhotonSettings>().middle_cells = lattices.of<PhotonSettings>().high_cells = 64;
    stages.push_back({"isllpm", s, lattices});
    s.of<PhotonSettings>().caustic_paths = 4096;
    s.of<PhotonSettings>().screen_gathers = 1;
    RenderSettings gathers = s;
    gathers.width = gathers.height = 64;
    gathers.of<PhotonSettings>().screen_gathers = 1000;
    stages.push_back({"multi_image", s, gathers});
    for (Stage const& stage : stages)
        for (PhotonMethod const& m : kPhotonMethods) {
            if (std::string_view(m.name) != stage.method) continue;
            std::uint64_t const asks = asks_of(m, world, stage.with);
            ASSERT_GT(asks, asks_of(m, world, stage.without)) << "there are some in the stage";
            expect_stops(m, world, stage.with, asks);
        }
}

/// Stops a render that many asks after its first pass. The result is empty if it throws Interrupted.
RenderResult stop_after_first_pass(PhotonMethod const& m, World const& world, RenderSettings const& s,
                                   std::uint64_t more)
{
    StopAtAsk stop;
    Report report;
    RenderResult r;
    try {
        r = m.render(
            world, in_the_room(), s, stop, [&](RenderStatus const&) { stop.request_after(more); }, report);
    } catch (Interrupted const&) {
    }
    EXPECT_LE(stop.asks(), stop.ask() + asks_until_noticed()) << m.name;
    return r;
}

/// A stop while caustics are traced keeps the finished passes, also if no light ever reached the mirror.
TEST(PhotonStops, WithoutCausticPhotons)
{
    Scene scene;
    add_box(scene, vec3{-1}, vec3{1}, add_material(scene, lambert(vec3{0.5f})), true);
    add_box(scene, vec3{2}, vec3{3}, add_material(scene, mirror(vec3{0.9f})), false);
    add_light(scene, point_light({0.2f, 0.3f, 0.1f}));
    World const world = world_of(scene);
    for (PhotonMethod const& m :
         {kPhotonMethods[0], PhotonMethod{"sh_grid", render_sh_grid, start_sh_grid_frames}}) {
        RenderSettings s = small_photon_picture(8, 4096);
        s.of<ShGridSettings>().voxels = 16;
        s.paths = 1000;
        s.of<PhotonSettings>().caustic_paths = 65536;
        RenderResult const r = stop_after_first_pass(m, world, s, 100);
        EXPECT_EQ(r.end, RenderEnd::interrupted) << m.name;
        EXPECT_GE(r.paths, 1u) << m.name;
    }
}

/// Passes with photons of their own take longer than the first one, whose photons there are already: a stop is
/// obeyed within them all the same.
TEST(PhotonStops, BetweenPasses)
{
    World const world = world_of(room_with_mirror());
    for (PhotonMethod const& m : kPhotonMethods) {
        RenderSettings s = small_photon_picture(8, 16384);
        s.paths = 1000;
        RenderResult const r = stop_after_first_pass(m, world, s, 1000);
        EXPECT_EQ(r.end, RenderEnd::interrupted) << m.name;
        EXPECT_GE(r.paths, 1u) << m.name;
    }
}

} // namespace
} // namespace gi::test
