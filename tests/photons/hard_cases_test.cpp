// Scenes and settings that could break the photon methods: each becomes a picture of finite numbers or is refused.

#include "gi/core/error.h"
#include "gi/methods/sh_grid/settings.h"
#include "gi/methods/sh_grid/sh_grid.h"
#include "tests/photons/photon_methods.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <ctime>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <thread>

namespace gi::test {
namespace {

using Clock = std::chrono::steady_clock;

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

/// A moment by the clock and by the processor time of this process.
class Stopwatch {
public:
    /// Seconds, of the processor where that is less: on a busy machine others may have it for a second. More than
    /// 3 s by the clock are no such delay.
    double until(Stopwatch const& end) const
    {
        double const wall = std::chrono::duration<double>(end.wall_ - wall_).count();
        return wall > 3 ? wall : std::min(wall, double(end.processor_ - processor_) / CLOCKS_PER_SEC);
    }

private:
    Clock::time_point wall_ = Clock::now();
    std::clock_t processor_ = std::clock();
};

/// A stop while light paths are traced, or what they need is built, is obeyed soon.
TEST(PhotonStops, WhileLightPathsAreTraced)
{
    World const world = world_of(room_with_mirror());
    for (PhotonMethod const& m : kPhotonMethods)
        for (double const after_s : {0.2, 1.0}) {
            RenderSettings s = small_photon_picture(8, 4000000);
            StopRequest stop;
            Stopwatch asked;
            std::thread asks([&] {
                std::this_thread::sleep_for(std::chrono::duration<double>(after_s));
                asked = {};
                stop.request();
            });
            bool interrupted = false;
            Report report;
            try {
                m.render(world, in_the_room(), s, stop, {}, report);
            } catch (Interrupted const&) {
                interrupted = true;
            }
            double const took = asked.until({});
            asks.join();
            fmt::print("{}: stopped {:.3f} s after the request\n", m.name, took);
            EXPECT_TRUE(interrupted) << m.name << " had rendered already";
            EXPECT_LT(took, 0.2) << m.name;
        }
}

/// Requests a stop some time after the first pass. Returns the seconds from then to the end of the render,
/// or nothing if it throws Interrupted.
double stop_after_first_pass(PhotonMethod const& m, World const& world, Camera const& camera,
                             RenderSettings const& s, double after_s, RenderResult& result)
{
    StopRequest stop;
    std::atomic<bool> first_is_done = false;
    Stopwatch asked;
    std::thread asks([&] {
        while (!first_is_done) std::this_thread::sleep_for(std::chrono::milliseconds(2));
        std::this_thread::sleep_for(std::chrono::duration<double>(after_s));
        asked = {};
        stop.request();
    });
    Report report;
    try {
        result = m.render(
            world, camera, s, stop, [&](RenderStatus const&) { first_is_done = true; }, report);
    } catch (Interrupted const&) {
        result = {};
    }
    double const took = asked.until({});
    asks.join();
    return took;
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
        s.of<PhotonSettings>().caustic_paths = 16000000;
        RenderResult r;
        double const took = stop_after_first_pass(m, world, in_the_room(), s, 0.4, r);
        fmt::print("{}: {} passes, stopped {:.3f} s after the request\n", m.name, r.paths, took);
        EXPECT_EQ(r.end, RenderEnd::interrupted) << m.name;
        EXPECT_GE(r.paths, 1u) << m.name;
        EXPECT_LT(took, 0.2) << m.name;
    }
}

/// Stages after tracing are as long as paths and steps are many: a stop is obeyed in them, too.
TEST(PhotonStops, AfterTracing)
{
    World const world = world_of(room_with_mirror());
    struct Stage {
        char const *method, *name;
        RenderSettings settings;
    };
    std::vector<Stage> stages;
    RenderSettings s = small_photon_picture(8, 600000);
    s.of<PhotonSettings>().caustic_paths = 0;
    s.of<PhotonSettings>().low_cells = s.of<PhotonSettings>().middle_cells = s.of<PhotonSettings>().high_cells = 128;
    stages.push_back({"isllpm", "light lattices", s});
    stages.push_back({"ispm", "photon map", s});
    s = small_photon_picture(256, 4096);
    s.of<PhotonSettings>().caustic_paths = 4096;
    s.of<PhotonSettings>().screen_gathers = 1000;
    stages.push_back({"multi_image", "caustics on screen", s});
    for (Stage const& stage : stages)
        for (PhotonMethod const& m : kPhotonMethods) {
            if (std::string_view(m.name) != stage.method) continue;
            // How long a run takes to the stage, and in it; by the last one that ended,
            // as machines do other work, too.
            double before = 0, in_stage = 0;
            auto const run = [&](StopRequest const& stop) {
                Report report;
                auto const begun = Clock::now();
                try {
                    m.render(world, in_the_room(), stage.settings, stop, {}, report);
                } catch (Interrupted const&) {
                    return false;
                }
                before = std::chrono::duration<double>(Clock::now() - begun).count();
                in_stage = 0;
                for (auto const& [name, seconds] : report.times())
                    if (name == stage.name) in_stage += seconds;
                before -= in_stage;
                return true;
            };
            ASSERT_TRUE(run({}));
            fmt::print("{}: {:.3f} s to {}, {:.3f} s in it\n", m.name, before, stage.name, in_stage);
            ASSERT_GT(in_stage, 0.1) << "too short to tell";
            for (double const share : {0.1, 0.5}) {
                bool interrupted = false;
                for (int attempt = 0; attempt < 5 && !interrupted; ++attempt) {
                    StopRequest stop;
                    Stopwatch asked;
                    std::thread asks([&, after_s = before + share * in_stage] {
                        std::this_thread::sleep_for(std::chrono::duration<double>(after_s));
                        asked = {};
                        stop.request();
                    });
                    interrupted = !run(stop);
                    Stopwatch const end;
                    asks.join();
                    double const took = asked.until(end);
                    if (interrupted) fmt::print("{}: stopped {:.3f} s after the request\n", m.name, took);
                    EXPECT_LT(took, 0.2) << m.name;
                }
                EXPECT_TRUE(interrupted) << m.name;
            }
        }
}

/// Passes with photons of their own take longer than the first one, whose photons there are already: a stop is
/// obeyed within about one of them all the same.
TEST(PhotonStops, BetweenPasses)
{
    World const world = world_of(room_with_mirror());
    for (PhotonMethod const& m : kPhotonMethods) {
        RenderSettings s = small_photon_picture(8, 65536);
        s.paths = 100000;
        RenderResult r;
        double const took = stop_after_first_pass(m, world, in_the_room(), s, 1, r);
        fmt::print("{}: {} passes, stopped {:.3f} s after the request\n", m.name, r.paths, took);
        EXPECT_EQ(r.end, RenderEnd::interrupted);
        EXPECT_LT(took, 0.5) << m.name;
    }
}

} // namespace
} // namespace gi::test
