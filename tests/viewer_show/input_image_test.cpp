// Real keys, mouse and window sizes.

#include "gi/image_io/picture_file.h"
#include "tests/viewer_show/input.h"
#include "viewer/protocol/recording/recording.h"

#include <atomic>
#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <map>

namespace viewer::test {
namespace {

TEST_F(Input, KeysMoveTheCamera)
{
    open("cornell --size 200x150" + kStill, "Lightwell: cornell");
    NEED_KEYS();
    view->settle();
    struct {
        char const* key;
        glm::dvec3 way; ///< it looks along +Z, so that right is -X
    } const moves[] = {{"w", {0, 0, 1}}, {"s", {0, 0, -1}}, {"d", {-1, 0, 0}},     {"a", {1, 0, 0}},
                       {"e", {0, 1, 0}}, {"q", {0, -1, 0}}, {"Right", {-1, 0, 0}}, {"Up", {0, 0, 1}}};
    for (auto const& [key, way] : moves) {
        glm::dvec3 const before = position();
        window->press(key);
        EXPECT_TRUE(is_soon([&] { return glm::dot(position() - before, way) > 0.005; })) << key;
        window->release(key);
        EXPECT_TRUE(is_soon([&] {
            glm::dvec3 const at = position();
            sleep_ms(200);
            return position() == at;
        })) << key
            << " was released";
        glm::dvec3 const by = position() - before;
        EXPECT_LT(glm::length(by - glm::dot(by, way) * way), 1e-9) << key;
    }
    view->quit();
}

TEST_F(Input, MouseTurnsNearsAndSelects)
{
    open("cornell --size 200x150" + kStill, "Lightwell: cornell");
    NEED_KEYS();
    view->settle();
    Json const before = rotation();
    window->point_at({100, 75});
    window->press_button(1);
    for (int i = 1; i <= 5; ++i) {
        window->point_at({100 + 4 * i, 75});
        sleep_ms(20);
    }
    window->release_button(1);
    EXPECT_TRUE(is_soon([&] { return rotation() != before; })) << "a drag turns";
    glm::dvec3 const at = position();
    window->press_button(4); // the wheel, away from the user
    window->release_button(4);
    EXPECT_TRUE(is_soon([&] { return position().z > at.z; })) << "the wheel nears";
    view->quit();
}

TEST_F(Input, PictureFollowsTheWindowsSize)
{
    open("cornell --size 200x150" + kStill, "Lightwell: cornell");
    for (glm::ivec2 const size : {glm::ivec2{401, 303}, {64, 300}, {1, 1}, {200, 150}}) {
        window->resize(size);
        Json const stats = view->settle();
        EXPECT_EQ(stats.at("views").at(0).at("width"), size.x);
        EXPECT_EQ(stats.at("views").at(0).at("height"), size.y);
        view->screenshot("shot.png");
        gi::Picture const shot = gi::read_picture(view->folder() / "shot.png");
        EXPECT_EQ(glm::ivec2(shot.width, shot.height), size);
    }
    view->quit();
}

TEST_F(Input, ClosingTheWindowEndsInOrder)
{
    open("cornell --size 200x150 --record walk.lwr", "Lightwell: cornell");
    view->ask({{"do", "camera"}}); // answered when there is a scene
    window->ask_to_close();
    Outcome const o = view->program().wait(std::chrono::seconds(20));
    EXPECT_EQ(o.code, 0) << "signal " << o.signal << "\n" << o.err;
    EXPECT_NE(run_well("recording info walk.lwr --json", view->folder().path()).out.find("in order"),
              std::string::npos);
}

TEST_F(Input, EscapeEndsInOrder)
{
    open("cornell --size 200x150", "Lightwell: cornell");
    NEED_KEYS();
    window->tap("Escape");
    Outcome const o = view->program().wait(std::chrono::seconds(20));
    EXPECT_EQ(o.code, 0) << "signal " << o.signal << "\n" << o.err;
}

TEST_F(Input, RemoteKeysAreAnsweredWithTheFrameThatHasSeenThem)
{
    open("cornell --size 200x150" + kStill, "Lightwell: cornell");
    int const before = view->settle().at("frame");
    glm::dvec3 const at = position();
    Json const result = view->ask({{"do", "key"}, {"key", "w"}});
    EXPECT_GT(result.at("frame"), before);
    EXPECT_TRUE(is_soon([&] { return position().z > at.z; }));
    Json const wrong = view->answer({{"do", "key"}, {"key", "nothing"}});
    EXPECT_TRUE(wrong.contains("error")) << wrong;
    view->quit();
}

TEST_F(Input, RemoteKeysThatChangeNothingAreAnsweredToo)
{
    open("cornell --size 200x150" + kStill, "Lightwell: cornell");
    view->settle();
    EXPECT_TRUE(view->answer({{"do", "key"}, {"key", "shift"}}, std::chrono::seconds(5)).contains("result"));
    view->quit();
}

/// "Until the picture refines no further" is at once where it does not refine.
TEST_F(Input, ExposureFollowsAndHolds)
{
    open("cornell --size 80x60 --set exposure=-6 --record walk.lwr" + kStill, "Lightwell: cornell");
    view->settle();
    view->ask({{"do", "key"}, {"key", "t"}}); // on
    EXPECT_TRUE(is_soon([&] { return view->settle().value("exposure", -6.0) > -3; })) << "it is not that dark";
    double const found = view->settle().at("exposure");
    EXPECT_EQ(view->ask({{"do", "get"}, {"key", "auto_exposure"}}).at("value"), "on");
    view->ask({{"do", "key"}, {"key", "+"}});
    EXPECT_EQ(view->ask({{"do", "get"}, {"key", "auto_exposure"}}).at("value"), "hold");
    EXPECT_NEAR(view->settle().at("exposure").get<double>(), found + 0.25, 1e-6);
    view->quit();
    Outcome const o = run_well("view --replay walk.lwr", view->folder().path());
    EXPECT_NE(o.out.find(" 0 not, 0 unknown"), std::string::npos) << o.out;
}

/// By its key, while a head walks; what was rendered and what was shown are replayed.
TEST_F(Input, HeadlightGoesAlong)
{
    open("cornell --size 80x60 --record walk.lwr --hash-shown --set panel=false --set refine=false",
         "Lightwell: cornell");
    view->settle();
    view->ask({{"do", "key"}, {"key", "l"}});
    view->settle();
    EXPECT_EQ(view->ask({{"do", "get"}, {"key", "headlight"}}).at("value"), true);
    view->ask({{"do", "key"}, {"key", "w"}, {"action", "press"}});
    sleep_ms(700);
    view->ask({{"do", "key"}, {"key", "w"}, {"action", "release"}});
    view->settle();
    view->ask({{"do", "key"}, {"key", "l"}});
    view->settle();
    EXPECT_EQ(view->ask({{"do", "get"}, {"key", "headlight"}}).at("value"), false);
    view->quit();
    Outcome const o = run_well("view --replay walk.lwr --shown", view->folder().path());
    std::string const all = " 0 not, 0 unknown\n";
    std::size_t const rendered = o.out.find(all);
    ASSERT_NE(rendered, std::string::npos) << o.out;
    EXPECT_NE(o.out.find(all, rendered + 1), std::string::npos) << "shown: " << o.out;
}

TEST_F(Input, ConvergedScreenshotOfAPictureThatRests)
{
    open("cornell --size 200x150" + kStill, "Lightwell: cornell");
    view->settle();
    Json const shot{{"do", "screenshot"}, {"file", view->folder() / "rests.png"}, {"converged", true}};
    EXPECT_TRUE(view->answer(shot, std::chrono::seconds(5)).contains("result"));
    view->quit();
}

/// The recording contains the camera of the frame.
TEST_F(Input, ScreenshotsShowWhatWasAskedBeforeThem)
{
    view.emplace("cornell --size 64x48 --record walk.lwr --set reproject=false");
    std::map<std::uint64_t, glm::dvec3> asked;
    auto const shoot = [&](glm::dvec3 at) { asked[std::uint64_t(view->screenshot("shot.png"))] = at; };
    for (int i = 0; i < 5; ++i) {
        glm::dvec3 const at{0.2 + 0.03 * i, 0.25, -0.5};
        view->ask({{"do", "camera"}, {"position", {at.x, at.y, at.z}}});
        shoot(at);
    }
    view->ask({{"do", "load"}, {"scene", "mirror"}});
    shoot(position()); // the first camera of the other scene
    view->quit();
    std::size_t found = 0;
    RecordingReader walk(view->folder() / "walk.lwr");
    while (auto const f = walk.next())
        if (auto const a = asked.find(f->command.frame); a != asked.end()) {
            ++found;
            EXPECT_LT(glm::distance(glm::dvec3(f->command.views[0].camera.world_from_camera[3]), a->second), 1e-9)
                << "frame " << f->command.frame;
        }
    EXPECT_EQ(found, asked.size());
}

TEST_F(Input, WhatCannotBeAskedIsRefused)
{
    view.emplace("cornell --size 64x48" + kStill);
    view->settle();
    std::string const shot = view->folder() / "shot.png";
    for (Json const& request :
         {Json{{"do", "screenshot"}, {"file", shot}, {"view", -1}},
          Json{{"do", "screenshot"}, {"file", shot}, {"view", 1}},
          Json{{"do", "pick"}, {"x_px", -5}, {"y_px", 10}}, Json{{"do", "pick"}, {"x_px", 5}, {"y_px", 1e9}},
          Json{{"do", "seek"}, {"time_s", 1e308}}, Json{{"do", "camera"}, {"position", {1e300, 0, 0}}},
          Json{{"do", "get"}, {"key", "light.0.intensity"}}})
        EXPECT_TRUE(view->answer(request).contains("error")) << request;
    EXPECT_FALSE(std::filesystem::exists(shot));
    view->quit();
}

} // namespace
} // namespace viewer::test
