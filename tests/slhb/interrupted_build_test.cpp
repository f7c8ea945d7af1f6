// A stop while a pass builds or traces ends the render soon, and keeps the passes before, so that a resumed render
// has the same bits as an undisturbed one.

#include "gi/methods/registry.h"
#include "gi/scene/generate/generate.h"
#include "gi/scene/motion/moving_world.h"
#include "tests/slhb/slhb_render.h"

#include <chrono>
#include <gtest/gtest.h>
#include <thread>

namespace gi::test {
namespace {

using Clock = std::chrono::steady_clock;

TEST(InterruptedBuild, OfALaterPassKeepsThePicture)
{
    World const world = world_of(generate_boxes(20000, 1));
    RenderSettings s;
    s.width = s.height = 16;
    s.paths = 1000;
    s.of<SlhbSettings>().schedule = Schedule::streamed;
    s.of<SlhbSettings>().axes = 64; // some tenths of a second for each pass
    s.of<SlhbSettings>().resolution = 256;
    StopRequest stop;
    std::jthread asks;
    Clock::time_point asked;
    Report report;
    RenderResult const r = render_as_set(
        world, look_at({0, 0, 3}, {0, 0, 0}, 50), s, stop,
        [&](RenderStatus const& now) {
            if (now.paths >= 2 && !asks.joinable())
                asks = std::jthread([&] { // while the next pass is being prepared
                    std::this_thread::sleep_for(std::chrono::milliseconds(20));
                    asked = Clock::now();
                    stop.request();
                });
        },
        report);
    double const took_s = std::chrono::duration<double>(Clock::now() - asked).count();
    EXPECT_EQ(r.end, RenderEnd::interrupted);
    EXPECT_GE(r.paths, 2u);
    EXPECT_FALSE(r.picture.layers.empty());
    RecordProperty("seconds", std::to_string(took_s));
}

RenderSettings settings_of_long_passes()
{
    RenderSettings s;
    s.threads = 1;
    s.width = s.height = 512; // some tenths of a second for each pass
    s.paths = 12;
    s.of<SlhbSettings>().directions = "icosahedron:20";
    s.of<SlhbSettings>().resolution = 64;
    return s;
}

TEST(InterruptedPass, TheFirstIsGivenUp)
{
    World const world = world_of(generate_boxes(2000, 1));
    RenderSettings s = settings_of_long_passes();
    s.width = s.height = 1024;
    StopRequest stop;
    stop.request();
    Report report;
    auto const begun = Clock::now();
    EXPECT_THROW(render_as_set(world, look_at({0, 0, 3}, {0, 0, 0}, 50), s, stop, {}, report), Interrupted);
    RecordProperty("seconds", std::to_string(std::chrono::duration<double>(Clock::now() - begun).count()));
}

TEST(InterruptedPass, ALaterOneLeavesNoTrace)
{
    World const world = world_of(generate_boxes(2000, 1));
    Camera const camera = look_at({0, 0, 3}, {0, 0, 0}, 50);
    RenderSettings s = settings_of_long_passes();
    Report report;
    RenderResult const whole = render_as_set(world, camera, s, {}, {}, report);
    s.checkpoint = std::filesystem::temp_directory_path() / "lightwell_interrupted_pass.state";
    std::filesystem::remove(s.checkpoint);
    StopRequest stop;
    std::jthread asks;
    auto const in_the_next_pass = [&](RenderStatus const& now) {
        if (now.paths >= 2 && !asks.joinable())
            asks = std::jthread([&] {
                std::this_thread::sleep_for(std::chrono::milliseconds(30));
                stop.request();
            });
    };
    RenderResult const part = render_as_set(world, camera, s, stop, in_the_next_pass, report);
    ASSERT_EQ(part.end, RenderEnd::interrupted);
    ASSERT_TRUE(part.resumable);
    EXPECT_LT(part.paths, s.paths);
    s.resume = true;
    RenderResult const resumed = render_as_set(world, camera, s, {}, {}, report);
    std::filesystem::remove(s.checkpoint);
    EXPECT_EQ(resumed.paths, s.paths);
    for (std::size_t k = 0; k < whole.picture.layers.size(); ++k)
        EXPECT_TRUE(resumed.picture.layers[k].data == whole.picture.layers[k].data)
            << whole.picture.layers[k].name;
}

/// Of --reuse and --shutter: a frame whose pass a stop meets is not one.
TEST(InterruptedPass, OfAFrameIsGivenUpByEveryMethod)
{
    Camera const camera = look_at({0, 0, 3}, {0, 0, 0}, 50);
    RenderSettings s;
    s.width = s.height = 1024; // some tenths of a second, and a first pass goes on for 0.08 s
    s.paths = 1;
    s.of<SlhbSettings>().resolution = 64;
    Moments const moments = [&](std::uint32_t) { return Moment{.changes = {}, .camera = camera}; };
    for (Method const& m : methods())
        for (bool const blurs : {false, true}) {
            Report report;
            MovingWorld const world(std::make_shared<Scene const>(generate_boxes(2000, 1)), 0, report);
            auto const frames = m.frames(world, camera, s, report);
            StopRequest stop;
            stop.request();
            try {
                RenderResult const r = frames->frame(camera, stop, {}, blurs ? moments : Moments{});
                EXPECT_EQ(r.end, RenderEnd::interrupted) << m.name;
                EXPECT_EQ(r.paths, 0u) << m.name;
            } catch (Interrupted const&) { // it has nothing at all
            }
        }
}

} // namespace
} // namespace gi::test
