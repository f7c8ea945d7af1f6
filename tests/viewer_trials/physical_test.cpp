// Degrees, cd/m2 and gaze of stimuli, without a window.

#include "gi/core/error.h"
#include "study/display/geometry.h"
#include "viewer/experiment/gaze/lsl_gaze.h"
#include "viewer/experiment/stimuli/physical.h"
#include "viewer/experiment/stimuli/stimulus_settings.h"

#include <cmath>
#include <fstream>
#include <gtest/gtest.h>

namespace viewer::test {
namespace {

study::DisplayModel model()
{
    study::DisplayModel m;
    m.screen = study::ScreenGeometry{1920, 1080, 53.1, 29.87, 57.3, "typed"};
    m.luminance.emplace();
    m.luminance->black = 0.4;
    m.luminance->channels = {study::ChannelCurve{20, 2.2, 1, {}, 0, 0, 0},
                             study::ChannelCurve{70, 2.2, 1, {}, 0, 0, 0},
                             study::ChannelCurve{9.6, 2.2, 1, {}, 0, 0, 0}};
    return m;
}

StimulusSettings with(std::string const& key, std::string const& value)
{
    return stimulus_settings({{"scene", "cornell"}, {key, value}}, "");
}

std::string problem_of(auto const& call)
{
    try {
        call();
    } catch (gi::InputError const& e) {
        return e.what();
    }
    return "none";
}

TEST(PhysicalUnits, AreReadFromSettings)
{
    auto const size = [](std::string const& text) { return *with("size", text).physical.size; };
    EXPECT_EQ(size("4 deg"), (StimulusLength{4, 4, StimulusUnit::deg}));
    EXPECT_EQ(size("4 x 3 deg"), (StimulusLength{4, 3, StimulusUnit::deg}));
    EXPECT_EQ(size("8 cm"), (StimulusLength{8, 8, StimulusUnit::cm}));
    EXPECT_EQ(size("2.5"), (StimulusLength{2.5, 2.5, StimulusUnit::deg})) << "as a procedure varies it";
    EXPECT_EQ(*with("place", "-5 2.5 deg").physical.place, (StimulusLength{-5, 2.5, StimulusUnit::deg}));
    EXPECT_EQ(*with("luminance", "80 cd/m2").physical.luminance, (StimulusLuminance{LuminanceOf::white, 80}));
    EXPECT_EQ(*with("peak_luminance", "60").physical.luminance, (StimulusLuminance{LuminanceOf::peak, 60}));
    EXPECT_NE(with("size", "4 deg").sha256, with("size", "5 deg").sha256);
    EXPECT_EQ(with("size", "4 deg").sha256, with("size", "4 x 4 deg").sha256);
}

TEST(PhysicalUnits, MistakesHaveOneClearMessage)
{
    for (auto const& [key, value] : std::vector<std::pair<std::string, std::string>>{{"size", "4 degrees"},
                                                                                     {"size", "wide"},
                                                                                     {"size", "-1 deg"},
                                                                                     {"size", "4 x 3 x 2 deg"},
                                                                                     {"size", "200 deg"},
                                                                                     {"place", "5 deg"},
                                                                                     {"luminance", "80 nits"},
                                                                                     {"luminance", "0"},
                                                                                     {"mean_luminance", "dim"}})
        EXPECT_NE(problem_of([&, k = key, v = value] { with(k, v); }).find(key + ": " + value), std::string::npos)
            << key << ": " << value;
}

TEST(PhysicalUnits, NeedADisplayModelThatCanShowThem)
{
    study::DisplayModel m = model();
    auto const check = [&](std::string const& key, std::string const& value, bool has_model = true) {
        return problem_of([&] { check_physical(with(key, value).physical, has_model ? &m : nullptr); });
    };
    EXPECT_EQ(check("size", "4 deg"), "none");
    EXPECT_EQ(check("size", "300 px", false), "none");
    EXPECT_NE(check("size", "4 deg", false).find("--display-model"), std::string::npos);
    EXPECT_NE(check("luminance", "80", false).find("--display-model"), std::string::npos);
    EXPECT_NE(check("size", "60 deg").find("the screen has 1920 x 1080"), std::string::npos);
    EXPECT_EQ(check("place", "20 0"), "none");
    EXPECT_NE(check("place", "0 -16").find("beyond the edge of the screen's 1920 x 1080 px"), std::string::npos);
    EXPECT_NE(check("peak_luminance", "120").find("0.4 to 100 cd/m2"), std::string::npos);
    EXPECT_EQ(check("luminance", "120"), "none") << "white may be clipped: it is counted";
    m.screen->distance_cm = 0;
    EXPECT_NE(check("size", "4 deg").find("no distance"), std::string::npos);
    EXPECT_EQ(check("size", "8 cm"), "none");
    m.luminance->is_absolute = false;
    EXPECT_NE(check("luminance", "80").find("none in cd/m2"), std::string::npos);
}

TEST(PhysicalUnits, PlaceTheStimulusInPixels)
{
    study::DisplayModel const m = model();
    PlacedPixels const p = placed_within(with("size", "4 deg").physical, &m, {100, 50}, {800, 600});
    int const side = int(std::lround(study::px_of_size(*m.screen, 4, false)));
    EXPECT_NEAR(p.size_px.x, side, 1);
    EXPECT_EQ(p.corner_px.x, 100 + (800 - p.size_px.x) / 2);
    StimulusSettings aside =
        stimulus_settings({{"scene", "cornell"}, {"size", "2 deg"}, {"place", "5 -1 deg"}}, "");
    PlacedPixels const q = placed_within(aside.physical, &m, {0, 0}, {1920, 1080});
    EXPECT_NEAR(q.corner_px.x + 0.5 * q.size_px.x - 960, study::px_of_place(*m.screen, 5, false), 1);
    EXPECT_NEAR(q.corner_px.y + 0.5 * q.size_px.y - 540, study::px_of_place(*m.screen, 1, true), 1) << "down";
    for (char const* const place : {"20 0 deg", "-20 0 deg", "0 8 deg", "0 -8 deg"})
        EXPECT_NE(
            problem_of([&] {
                placed_within(
                    stimulus_settings({{"scene", "cornell"}, {"size", "10 deg"}, {"place", place}}, "").physical,
                    &m, {100, 0}, {800, 600});
            }).find("its place in the window"),
            std::string::npos)
            << place;
    EXPECT_NE(problem_of([&] { placed_within(with("size", "20 deg").physical, &m, {0, 0}, {300, 300}); }), "none");
    PlacedPixels const whole = placed_within({}, nullptr, {3, 4}, {5, 6});
    EXPECT_EQ(whole.size_px, glm::ivec2(5, 6));
}

TEST(PhysicalUnits, MeansAndPeaksAreThoseOnTheDisplay)
{
    study::DisplayModel const m = model();
    gi::Layer const picture{"color", 3, {0.1f, 0.1f, 0.1f, 0.3f, 0.3f, 0.3f, 0.2f, 0.2f, 0.2f, 0.2f, 0.2f, 0.2f}};
    auto const table = make_inverse_table(*m.luminance);
    for (auto const& [key, value] : {std::pair{"mean_luminance", 20.0}, {"peak_luminance", 60.0}}) {
        DisplayLight const light =
            light_of(with(key, std::to_string(value)).physical, *m.luminance, table, &picture, {});
        ShownLight const shown = shown_light(picture, {}, light, *m.luminance);
        EXPECT_NEAR(std::string(key) == "mean_luminance" ? shown.mean_cd_m2 : shown.peak_cd_m2, value, 1e-3);
        EXPECT_EQ(shown.bright + shown.dark, 0u);
    }
}

TEST(PhysicalUnits, AMeanIsReachedAlthoughALampIsClipped)
{
    study::DisplayModel const m = model();
    gi::Layer picture{"color", 3, {}};
    for (int i = 0; i < 300; ++i) picture.data.push_back(i < 12 ? 500.0f : 0.2f);
    auto const table = make_inverse_table(*m.luminance);
    DisplayLight const light = light_of(with("mean_luminance", "20").physical, *m.luminance, table, &picture, {});
    ShownLight const shown = shown_light(picture, {}, light, *m.luminance);
    EXPECT_NEAR(shown.mean_cd_m2, 20, 1e-3);
    EXPECT_EQ(shown.bright, 4u) << "pixels of the lamp";
    gi::Layer const dark{"color", 3, {500.0f, 500.0f, 500.0f, 0, 0, 0, 0, 0, 0}};
    EXPECT_THROW(light_of(with("mean_luminance", "80").physical, *m.luminance, table, &dark, {}), gi::InputError);
}

TEST(GazeChannels, AreFoundByTheirLabels)
{
    auto const c =
        gaze_channels({"timestamp", "left_gaze_point_on_display_area_0", "left_gaze_point_on_display_area_1",
                       "left_gaze_origin_in_user_coordinate_system_0", "right_gaze_point_on_display_area_0",
                       "right_gaze_point_on_display_area_1", "left_pupil_diameter", "validity"},
                      std::vector<std::string>(8));
    ASSERT_TRUE(c);
    EXPECT_EQ(c->x, 1);
    EXPECT_EQ(c->y, 2);
    EXPECT_EQ(c->other_x, 4);
    EXPECT_EQ(c->other_y, 5);
    EXPECT_EQ(c->pupil, 6);
    EXPECT_EQ(c->valid, 7);
    EXPECT_TRUE(c->is_normalised);
    EXPECT_FALSE(gaze_channels({"gaze_x", "gaze_y"}, {"px", "px"})->is_normalised);
    EXPECT_FALSE(gaze_channels({"alpha", "beta"}, {"", ""}));
    EXPECT_FALSE(gaze_channels({}, {}));
}

TEST(GazeChannels, SamplesAreMovedToTheWindow)
{
    GazeChannels c;
    c.x = 0;
    c.y = 1;
    GazePlace const place{{400, 300}, {500, 200}, {1600, 900}, {100, 0}};
    // (800, 450) of the monitor, (900, 450) on the desktop.
    study::GazeSample const s = gaze_sample(c, {0.5, 0.5}, 7, place);
    EXPECT_TRUE(s.is_valid);
    EXPECT_NEAR(s.x_px, 900 - (500 + 200), 1e-9);
    EXPECT_NEAR(s.y_px, 450 - (200 + 150), 1e-9);
    EXPECT_FALSE(gaze_sample(c, {NAN, 0.5}, 7, place).is_valid);
    c.other_x = 2;
    c.other_y = 3;
    EXPECT_NEAR(gaze_sample(c, {0.4, 0.5, 0.6, 0.5}, 7, place).x_px, s.x_px, 1e-9) << "between the eyes";
    EXPECT_NEAR(gaze_sample(c, {NAN, NAN, 0.5, 0.5}, 7, place).x_px, s.x_px, 1e-9) << "one eye";
}

TEST(GazeReplay, GoesRoundAndRound)
{
    std::string const file = testing::TempDir() + "lightwell_gaze.csv";
    std::ofstream(file) << "t_s,x_px,y_px,valid\n5,100,50,1\n5.01,101,50,1\n5.02,,,0\n";
    auto const source = open_gaze(file, 1000);
    GazePlace const place{{200, 100}, {}, {}, {}};
    auto const first = source->take(place, 1000.015);
    ASSERT_EQ(first.size(), 2u);
    EXPECT_NEAR(first[1].time_s, 1000.01, 1e-9);
    EXPECT_NEAR(first[1].x_px, 1, 1e-9) << "from the centre";
    auto const more = source->take(place, 1000.3);
    EXPECT_EQ(more.size(), 29u);
    EXPECT_FALSE(more[0].is_valid);
    for (std::size_t i = 1; i < more.size(); ++i) EXPECT_NEAR(more[i].time_s - more[i - 1].time_s, 0.01, 1e-6);
}

} // namespace
} // namespace viewer::test
