// A stop while the hit buffers of a later pass are built ends the render soon, and keeps the passes before.

#include "gi/methods/slhb/slhb.h"
#include "gi/scene/generate/generate.h"
#include "tests/support/scenes.h"

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
    s.slhb.look_ups = LookUps::all;
    s.slhb.schedule = Schedule::streamed;
    s.slhb.axes = 64; // some tenths of a second for each pass
    s.slhb.resolution = 256;
    StopRequest stop;
    std::jthread asks;
    Clock::time_point asked;
    Report report;
    RenderResult const r = render_slhb(
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

} // namespace
} // namespace gi::test
