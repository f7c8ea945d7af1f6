// Frames of the photon methods: they follow what changes, or keep their light if it is frozen; views; threads.

#include "gi/hit_buffers/settings.h"
#include "tests/photons/photon_methods.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace gi::test {
namespace {

MovingWorld moving_world(Report& report)
{
    return {std::make_shared<Scene const>(room_with_mirror()), 0.0, report};
}

/// Seconds so far of what traces or stores light.
double light_time(Report const& report)
{
    double sum = 0;
    for (auto const& [stage, seconds] : report.times())
        if (stage == "light paths" || stage == "caustic photons" || stage == "impostors" ||
            stage == "photon map" || stage == "light propagation" || stage == "light lattices" ||
            stage == "light gathering volume")
            sum += seconds;
    return sum;
}

TEST(PhotonFrames, FollowLights)
{
    for (PhotonMethod const& m : kPhotonMethods) {
        Report report;
        MovingWorld moving = moving_world(report);
        auto const frames = m.start(moving, in_the_room(), small_photon_picture(16, 8192), report);
        double const lit = indirect(frames->frame(in_the_room(), {}, {}, {}).picture);
        EXPECT_GT(lit, 0) << m.name;
        Light half = moving.world().lights.at(0);
        half.intensity *= 0.5f;
        frames->changed(moving.set_light(0, half));
        EXPECT_NEAR(indirect(frames->frame(in_the_room(), {}, {}, {}).picture) / lit, 0.5, 0.05) << m.name;
        half.intensity = vec3{0};
        frames->changed(moving.set_light(0, half));
        EXPECT_EQ(indirect(frames->frame(in_the_room(), {}, {}, {}).picture), 0) << m.name;
    }
}

/// Light that is frozen is traced once, whatever the camera and the scene do, and a camera that comes back sees
/// what one sees that has never moved.
TEST(PhotonFrames, FrozenLight)
{
    Camera const here = in_the_room(), there = look_at({-0.8, 0.5, -0.8}, {0.5, -0.5, 0.5}, 70);
    for (PhotonMethod const& m : kPhotonMethods)
        for (bool const frozen : {true, false}) {
            RenderSettings s = small_photon_picture(16, 4096);
            s.of<PhotonSettings>().frozen = frozen ? Switch::on : Switch::off;
            s.of<PhotonSettings>().propagation_cascades = s.of<PhotonSettings>().lattice_cascades = 2;
            Picture last[2];
            for (bool const walks : {false, true}) {
                Report report;
                MovingWorld moving = moving_world(report);
                auto const frames = m.start(moving, here, s, report);
                double const first = indirect(frames->frame(here, {}, {}, {}).picture);
                double const after_first = light_time(report);
                EXPECT_GT(after_first, 0);
                for (int k = 0; k < 3; ++k) frames->frame(walks ? there : here, {}, {}, {});
                last[walks ? 1 : 0] = frames->frame(here, {}, {}, {}).picture;
                EXPECT_NEAR(indirect(last[walks ? 1 : 0]) / first, 1, 0.15) << m.name;
                // A frozen method may time what it no longer does.
                EXPECT_EQ(light_time(report) == after_first, frozen) << m.name;
                Light off = moving.world().lights.at(0);
                off.intensity = vec3{0};
                frames->changed(moving.set_light(0, off));
                double const dark = indirect(frames->frame(here, {}, {}, {}).picture);
                EXPECT_EQ(dark > 0.7 * first, frozen) << m.name;
            }
            EXPECT_EQ(last[0].find("color")->data == last[1].find("color")->data, frozen) << m.name;
        }
}

/// Glass that no light reaches has no caustics: that, too, is found out once.
TEST(PhotonFrames, FrozenLightWithoutCaustics)
{
    Scene scene;
    add_box(scene, vec3{-1}, vec3{1}, add_material(scene, lambert(vec3{0.5f})), true);
    add_box(scene, vec3{2}, vec3{3}, add_material(scene, mirror(vec3{0.9f})), false);
    Light lamp;
    lamp.position = {0.2f, 0.3f, 0.1f};
    lamp.intensity = vec3{1};
    add_light(scene, lamp);
    for (PhotonMethod const& m : kPhotonMethods) {
        RenderSettings s = small_photon_picture(8, 4096);
        s.of<PhotonSettings>().frozen = Switch::on;
        Report report;
        MovingWorld moving(std::make_shared<Scene const>(scene), 0.0, report);
        auto const frames = m.start(moving, in_the_room(), s, report);
        frames->frame(in_the_room(), {}, {}, {});
        double const after_first = light_time(report);
        for (int k = 0; k < 3; ++k) frames->frame(in_the_room(1 - 0.1 * k), {}, {}, {});
        EXPECT_EQ(light_time(report), after_first) << m.name;
    }
}

/// A corridor of 40 m with walls and blocks, lit evenly.
Scene corridor()
{
    Scene scene;
    int const wall = add_material(scene, lambert(vec3{0.6f}));
    add_box(scene, {-0.3f, -0.1f, -1}, {40, 2.1f, 1.1f}, wall, true);
    for (int k = 0; k < 10; ++k) {
        float const x = 4 * float(k) + 1.7f;
        add_box(scene, {x, -0.099f, -0.6f}, {x + 0.5f, 0.7f, -0.1f}, wall, false);
        Light lamp;
        lamp.position = {x, 1.8f, 0.5f};
        lamp.intensity = vec3{1};
        add_light(scene, lamp);
    }
    return scene;
}

/// Lattices about the camera follow it: after a walk and at rest it sees what one sees that has always been there.
TEST(PhotonFrames, LatticesFollowTheCamera)
{
    auto const at = [](double x) { return look_at({x, 1.2, 0.3}, {x + 2, 0.6, -0.2}, 70); };
    for (PhotonMethod const& m : kPhotonMethods) {
        if (std::string_view(m.name) == "ispm") continue;
        RenderSettings s = small_photon_picture(16, 8192);
        s.of<PhotonSettings>().lattice_cascades = s.of<PhotonSettings>().propagation_cascades = 4;
        s.of<PhotonSettings>().volume_gathers = 0;
        for (int const steps_at_rest : {0, 2}) {
            Picture seen[2];
            double cells[2] = {0, 0};
            for (bool const walks : {false, true}) {
                Report report;
                MovingWorld moving(std::make_shared<Scene const>(corridor()), 0.0, report);
                auto const frames = m.start(moving, at(17), s, report);
                for (double x = walks ? 1 : 17; x < 17; x += 4) frames->frame(at(x), {}, {}, {});
                for (int k = 0; k < steps_at_rest; ++k) frames->frame(at(17), {}, {}, {});
                seen[walks ? 1 : 0] = frames->frame(at(17), {}, {}, {}).picture;
                for (auto const& [what, count] : report.counts())
                    if (what == "cells with surfaces") cells[walks ? 1 : 0] = count;
            }
            std::vector<float> const &a = seen[0].find("L2")->data, &b = seen[1].find("L2")->data;
            double off = 0, sum = 0;
            for (std::size_t i = 0; i < a.size(); ++i) {
                off += std::abs(double(a[i] - b[i]));
                sum += double(a[i]);
            }
            fmt::print("{}, {} frames at rest: {:.4f} of the light differs, {} and {} cells\n", m.name,
                       steps_at_rest, off / sum, cells[0], cells[1]);
            EXPECT_EQ(cells[0], cells[1]) << m.name;
            // Rays of the pixels differ, of which the coarse cells of lpv show most.
            EXPECT_LT(off / sum, m.start == start_lpv_frames ? 0.08 : 0.03) << m.name;
        }
    }
}

/// A room at the border of a large world: the part that is shown does not change with each step of the camera, and
/// light is not traced again.
TEST(PhotonFrames, FocusAtTheBorderOfTheWorldStays)
{
    Scene scene;
    int const matt = add_material(scene, lambert(vec3{0.6f}));
    add_quad(scene, {-100, 0, -100}, {0, 0, 200}, {200, 0, 0}, matt); // its lower border is that of the world
    add_box(scene, {-1, 0.01f, -1}, {0, 0.5f, 0}, matt, false);
    set_environment(scene, vec3{1});
    Report report;
    MovingWorld moving(std::make_shared<Scene const>(scene), 0.0, report);
    RenderSettings const s = small_photon_picture(16, 4096);
    PhotonMethod const& m = kPhotonMethods[0];
    auto const at = [](double x) { return look_at({x, 1, 3}, {x, 0, 0}, 50); };
    auto const frames = m.start(moving, at(0), s, report);
    frames->frame(at(0), {}, {}, {});
    double const after_first = light_time(report);
    for (int k = 1; k < 4; ++k) frames->frame(at(0.01 * k), {}, {}, {});
    EXPECT_EQ(light_time(report), after_first);
}

TEST(PhotonFrames, AnyNumberOfThreadsGivesTheSameBits)
{
    World const world = world_of(room_with_mirror());
    for (PhotonMethod const& m : kPhotonMethods)
        for (PhotonRays const rays : {PhotonRays::exact, PhotonRays::look_ups, PhotonRays::impostors})
            for (FirstBounce const first : {FirstBounce::rays, FirstBounce::map}) {
                if (first == FirstBounce::map && rays != PhotonRays::exact) continue;
                RenderSettings s = small_photon_picture(16, 4096);
                s.paths = 2;
                s.of<PhotonSettings>().rays = rays;
                s.of<PhotonSettings>().first_bounce = first;
                s.of<SlhbSettings>().directions = "icosahedron:20";
                s.of<SlhbSettings>().resolution = 64;
                s.threads = 1;
                Report report;
                Picture const one = m.render(world, in_the_room(), s, {}, {}, report).picture;
                EXPECT_GT(indirect(one), 0) << m.name;
                s.threads = 3;
                Picture const other = m.render(world, in_the_room(), s, {}, {}, report).picture;
                for (Layer const& layer : one.layers) {
                    std::vector<float> const& data = other.find(layer.name)->data;
                    std::size_t differ = 0;
                    float most = 0;
                    for (std::size_t i = 0; i < data.size(); ++i) {
                        differ += data[i] != layer.data[i] ? 1 : 0;
                        most = std::max(most, std::abs(data[i] - layer.data[i]));
                    }
                    EXPECT_EQ(differ, 0u) << layer.name << " of " << m.name << " by 3 threads, by up to "
                                          << most;
                }
            }
}

/// Two eyes share photons; each sees what it would see alone, but for noise.
TEST(PhotonFrames, ViewsAreWhatOneViewWouldBe)
{
    Report report;
    MovingWorld const moving = moving_world(report);
    Camera const left = in_the_room(), right = look_at({0.26, 0.1, 0.9}, {0.06, -0.5, -0.4}, 80);
    for (PhotonMethod const& m : kPhotonMethods) {
        RenderSettings const s = small_photon_picture(32, 16384);
        FrameView const both[] = {{left, 32, 32}, {right, 24, 24, 0}};
        auto const together = m.start(moving, left, s, report)->views(both, 4, VertexSharing::none, {});
        ASSERT_EQ(together.size(), 2u);
        for (int k = 0; k < 2; ++k) {
            auto const alone = m.start(moving, left, s, report)->views({both + k, 1}, 4, VertexSharing::none, {});
            for (char const* const layer : {"L1", "L2"}) {
                double const a = mean_of(together[std::size_t(k)].picture, layer).mean,
                             b = mean_of(alone[0].picture, layer).mean;
                EXPECT_GT(b, 0);
                EXPECT_NEAR(a / b, 1, 0.02) << m.name << ", " << layer << " of view " << k;
            }
            EXPECT_NE(together[std::size_t(k)].picture.find("motion"), nullptr) << m.name;
        }
    }
}

} // namespace
} // namespace gi::test
