// A stop while a pass builds or traces ends the render soon, and keeps the passes before, so that a resumed render
// has the same bits as an undisturbed one.

#include "gi/methods/registry.h"
#include "gi/scene/generate/generate.h"
#include "gi/scene/motion/moving_world.h"
#include "tests/slhb/slhb_render.h"
#include "tests/support/stop_at_ask.h"

#include <gtest/gtest.h>

namespace gi::test {
namespace {

TEST(InterruptedBuild, OfALaterPassKeepsThePicture)
{
    World const world = world_of(generate_boxes(2000, 1));
    RenderSettings s;
    s.width = s.height = 16;
    s.paths = 1000;
    s.of<SlhbSettings>().schedule = Schedule::streamed;
    s.of<SlhbSettings>().axes = 64; // many asks for each pass
    s.of<SlhbSettings>().resolution = 64;
    StopAtAsk stop;
    Report report;
    std::uint32_t finished = 0; // when the stop is asked for
    RenderResult const r = render_as_set(
        world, look_at({0, 0, 3}, {0, 0, 0}, 50), s, stop,
        [&](RenderStatus const& now) {
            if (now.paths < 2 || finished > 0) return;
            finished = now.paths;
            stop.request_after(8); // while the next pass is being prepared
        },
        report);
    EXPECT_EQ(r.end, RenderEnd::interrupted);
    EXPECT_GE(finished, 2u);
    EXPECT_EQ(r.paths, finished);
    EXPECT_FALSE(r.picture.layers.empty());
}

RenderSettings settings_of_long_passes()
{
    RenderSettings s;
    s.threads = 1;
    s.width = s.height = 64; // several asks for each pass
    s.paths = 12;
    s.of<SlhbSettings>().directions = "icosahedron:20";
    s.of<SlhbSettings>().resolution = 64;
    return s;
}

TEST(InterruptedPass, TheFirstIsGivenUp)
{
    World const world = world_of(generate_boxes(2000, 1));
    Camera const camera = look_at({0, 0, 3}, {0, 0, 0}, 50);
    RenderSettings s = settings_of_long_passes();
    s.paths = 1;
    StopAtAsk stop(1), never;
    Report report;
    EXPECT_THROW(render_as_set(world, camera, s, stop, {}, report), Interrupted);
    render_as_set(world, camera, s, never, {}, report);
    EXPECT_LT(stop.asks(), never.asks()) << "of a whole picture";
}

TEST(InterruptedPass, ALaterOneLeavesNoTrace)
{
    World const world = world_of(generate_boxes(2000, 1));
    Camera const camera = look_at({0, 0, 3}, {0, 0, 0}, 50);
    RenderSettings s = settings_of_long_passes();
    s.width = s.height = 160; // a second or more in all: progress is shown meanwhile
    s.paths = 40;
    Report report;
    RenderResult const whole = render_as_set(world, camera, s, {}, {}, report);
    s.checkpoint = std::filesystem::temp_directory_path() / "lightwell_interrupted_pass.state";
    std::filesystem::remove(s.checkpoint);
    StopAtAsk stop;
    auto const in_the_next_pass = [&](RenderStatus const& now) {
        if (now.paths >= 2) stop.request_after(3);
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
    s.width = s.height = 64;
    s.paths = 1;
    s.of<SlhbSettings>().resolution = 64;
    Moments const moments = [&](std::uint32_t) { return Moment{.changes = {}, .camera = camera}; };
    for (Method const& m : methods())
        for (bool const blurs : {false, true}) {
            Report report;
            MovingWorld const world(std::make_shared<Scene const>(generate_boxes(2000, 1)), 0, report);
            auto const frames = m.frames(world, camera, s, report);
            StopAtAsk const stop(1);
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
