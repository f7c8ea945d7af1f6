// Stimuli from AR sessions, without a window: what is shown is known byte by byte.

#include "gi/core/error.h"
#include "study/script/script_file.h"
#include "study/script/setting_place.h"
#include "tests/viewer/run_program.h"
#include "viewer/experiment/prepared_list.h"
#include "viewer/experiment/stimuli/ar_source.h"

#include <fmt/format.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace viewer::test {
namespace {

namespace fs = std::filesystem;

cv::Mat picture(fs::path const& file)
{
    cv::Mat rgb = cv::imread(file.string(), cv::IMREAD_COLOR);
    cv::cvtColor(rgb, rgb, cv::COLOR_BGR2RGB);
    return rgb;
}

/// The synthetic desk, three frames at 30 Hz, made once.
class ArStimuli : public testing::Test {
protected:
    static void SetUpTestSuite()
    {
        folder_ = new TemporaryFolder;
        run_well("ar synthesize desk --frames 3 --size 64x48 --paths 2", folder_->path());
    }
    static void TearDownTestSuite() { delete folder_; }

    fs::path desk() const { return folder_->path() / "desk"; }
    StimulusSettings stimulus(study::Patch patch) const
    {
        patch.emplace_back("ar", "desk/session.yaml");
        return stimulus_settings(patch, "", folder_->path());
    }
    /// "" where nothing is wrong.
    std::string problem(study::Patch const& patch) const
    {
        try {
            check_ar_pictures(*stimulus(patch).ar);
        } catch (ArSettingError const& e) {
            return e.key + "|" + e.value + "|" + e.what();
        } catch (gi::InputError const& e) {
            return e.what();
        }
        return "";
    }
    std::vector<ArPicture> made(study::Patch const& patch, double duration_s = 6, int warmup = 0) const
    {
        gi::Report report;
        gi::StopRequest const stop;
        StimulusView view;
        view.size_px = {64, 48};
        view.duration_s = duration_s;
        view.warmup_frames = warmup;
        return make_ar_pictures(*stimulus(patch).ar, view, stop, report);
    }

    static TemporaryFolder* folder_;
};
TemporaryFolder* ArStimuli::folder_ = nullptr;

TEST_F(ArStimuli, ShowTheCamerasFramesAndTheTruthByteForByte)
{
    for (auto const& [show, from] : {std::pair{"camera", "frames"}, {"truth", "truth"}}) {
        auto const one = made({{"ar.show", show}, {"ar.frame", "2"}});
        ASSERT_EQ(one.size(), 1u);
        EXPECT_EQ(cv::norm(one[0].rgb, picture(desk() / from / "000002.png"), cv::NORM_INF), 0) << show;
        auto const all = made({{"ar.show", show}, {"ar.from_s", "0.03"}}, 0.06);
        ASSERT_EQ(all.size(), 2u) << "two of 30 Hz in 60 ms";
        EXPECT_EQ(cv::norm(all[1].rgb, picture(desk() / from / "000002.png"), cv::NORM_INF), 0) << show;
        EXPECT_NEAR(all[1].time_s, 1 / 30.0, 1e-9);
    }
}

TEST_F(ArStimuli, CompositesAreThoseOfArRunAndTheSameAgain)
{
    Outcome const o = run("ar run session.yaml --fast --poses poses.csv --out out", desk());
    ASSERT_EQ(o.code, 0) << o.err;
    auto const first = made({{"ar.poses", "poses.csv"}}), again = made({{"ar.poses", "poses.csv"}});
    ASSERT_EQ(first.size(), 3u);
    for (std::size_t f = 0; f < 3; ++f) {
        EXPECT_EQ(cv::norm(first[f].rgb, picture(desk() / fmt::format("out/{:06}.png", f)), cv::NORM_INF), 0) << f;
        EXPECT_EQ(cv::norm(first[f].rgb, again[f].rgb, cv::NORM_INF), 0) << f;
        EXPECT_TRUE(first[f].world_from_camera);
    }
    EXPECT_GT(cv::norm(first[0].rgb, picture(desk() / "frames/000000.png"), cv::NORM_INF), 20);
    // Frames before the stimulus initialise filters, and so determine its pictures.
    auto const warm = made({{"ar.poses", "poses.csv"}, {"ar.frame", "2"}}, 6, 2);
    ASSERT_EQ(warm.size(), 1u);
    EXPECT_EQ(cv::norm(warm[0].rgb, first[2].rgb, cv::NORM_INF), 0);
}

TEST_F(ArStimuli, SettingsGoOverThoseOfTheSession)
{
    StimulusSettings const s = stimulus({{"ar.render.paths", "16"},
                                         {"ar.composite.blend", "ratio"},
                                         {"ar.virtual.at", "[0.1, 0, 0]"},
                                         {"ar.light.map", "probe.exr"}});
    ar::Session const session = session_of(*s.ar);
    EXPECT_EQ(session.render.paths, 16u);
    EXPECT_EQ(session.composite.blend, ar::Blend::ratio);
    EXPECT_EQ(session.virtual_things.at_m, gi::dvec3(0.1, 0, 0));
    EXPECT_EQ(session.light, desk() / "probe.exr");
    EXPECT_EQ(session.camera, desk() / "camera.yaml");
    EXPECT_EQ(s.view, StimulusViewer::window);
    EXPECT_NE(s.sha256, stimulus({}).sha256);
    EXPECT_EQ(s.sha256.size(), 64u);
}

TEST_F(ArStimuli, WhatCannotBeIsRefusedByTheSettingToBlame)
{
    EXPECT_EQ(problem({{"ar.frame", "2"}}), "");
    for (auto const& [key, value] : std::vector<std::pair<std::string, std::string>>{{"ar.frame", "3"},
                                                                                     {"ar.frame", "-1"},
                                                                                     {"ar.frame", "1.5"},
                                                                                     {"ar.from_s", "0.2"},
                                                                                     {"ar.from_s", "nan"},
                                                                                     {"ar.show", "all"},
                                                                                     {"ar.render.paths", "0"},
                                                                                     {"ar.render.path", "1"},
                                                                                     {"ar.nothing", "1"},
                                                                                     {"ar.poses", "none.csv"},
                                                                                     {"ar.", "1"},
                                                                                     {"scene", "cornell"},
                                                                                     {"paths", "4"},
                                                                                     {"view", "openxr"}}) {
        std::string const found = problem({{key, value}});
        EXPECT_TRUE(found.starts_with(key + "|" + value + "|")) << key << ": " << value << " -> " << found;
    }
    EXPECT_NE(problem({{"ar.show", "truth"}, {"ar.truth", "nowhere"}}).find("nowhere"), std::string::npos);
    EXPECT_NE(problem({{"ar.frames.source", "camera"}}).find("ar record"), std::string::npos);
    EXPECT_THROW(stimulus_settings({{"ar.frame", "1"}}, ""), ArSettingError);
    EXPECT_THROW(stimulus_settings({{"ar", "none.yaml"}}, "", desk()), ArSettingError);
    EXPECT_THROW(stimulus_settings({{"ar", "session.yaml"}}, "front", desk()), gi::InputError);
}

TEST_F(ArStimuli, PreparedOnesAreFoundByTheBytesOfWhatTheyAreMadeOf)
{
    gi::Report report;
    gi::StopRequest const stop;
    StimulusView view;
    view.size_px = {88, 48};
    StimulusSettings const s = stimulus({{"ar.show", "camera"}, {"ar.frame", "1"}});
    std::string const key = prepared_key({s, view}, "v");
    fs::path const out = folder_->path() / "prepared";
    EXPECT_TRUE(prepare_stimulus({s, view}, out, key, {}, 1, stop, report));
    EXPECT_FALSE(prepare_stimulus({s, view}, out, key, {}, 1, stop, report)) << "it is there";

    ArSource source(out, "v", report);
    source.prepare(s, view);
    ASSERT_TRUE(source.is_ready());
    auto const frame = source.newest();
    ASSERT_TRUE(frame);
    // As wide as the place with grey beside it; the screen's sRGB makes the camera's bytes of it again.
    gi::Picture const& shown = frame->result.views.at(0).picture;
    cv::Mat const truth = picture(desk() / "frames/000001.png");
    ASSERT_EQ(shown.width, 88);
    auto const& color = shown.find("color")->data;
    int wrong = 0;
    for (int y = 0; y < 48; ++y)
        for (int x = 0; x < 88; ++x)
            for (int c = 0; c < 3; ++c) {
                int const is = int(255 * gi::encode_srgb(color[std::size_t(3 * (88 * y + x) + c)]) + 0.5f);
                wrong += is != (x < 12 || x >= 76 ? 128 : int(truth.at<cv::Vec3b>(y, x - 12)[c]));
            }
    EXPECT_EQ(wrong, 0);

    cv::Mat changed = cv::imread((desk() / "frames/000002.png").string());
    cv::imwrite((folder_->path() / "kept.png").string(), changed);
    changed.at<cv::Vec3b>(0, 0)[0] ^= 1;
    cv::imwrite((desk() / "frames/000002.png").string(), changed);
    EXPECT_NE(prepared_key({s, view}, "v"), key) << "a frame has changed";
    fs::copy_file(folder_->path() / "kept.png", desk() / "frames/000002.png",
                  fs::copy_options::overwrite_existing);
    view.size_px.x = 89;
    EXPECT_THROW(source.prepare(s, view), gi::InputError);
}

TEST_F(ArStimuli, LiveOnesPlayAtTheirPaceAndAgain)
{
    gi::Report report;
    StimulusView view;
    view.size_px = {64, 48};
    view.duration_s = 0.1;
    ArSource source("", "v", report);
    StimulusSettings const s = stimulus({{"ar.show", "camera"}});
    source.prepare(s, view);
    while (!source.is_ready()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    auto const at = [&](double t) {
        source.at(t);
        return source.newest();
    };
    auto const first = at(-1);
    EXPECT_EQ(at(0), first);
    EXPECT_EQ(at(0.03), first);
    EXPECT_NE(at(0.034), first);
    EXPECT_EQ(at(0.05), at(0.06));
    EXPECT_EQ(at(0.105)->result.views[0].picture.find("color")->data,
              first->result.views[0].picture.find("color")->data)
        << "from the beginning";
    EXPECT_THROW(source.walk({}, 0.1), gi::InputError);
    source.change(stimulus({{"ar.show", "truth"}}));
    EXPECT_TRUE(source.newest()) << "the old ones stay";
}

TEST(SettingPlaces, AreFoundWhereTheScriptHasThem)
{
    std::string const text = R"(factors:
  a: {x: {ar.frame: 1}, y: {ar.frame: 2}}
  ar.render.paths: [1, 4]
defaults: {settings: {ar: s.yaml}}
blocks:
  b: {compare: {vary: ar.light.scale}}
)";
    auto const at = [&](char const* key, char const* value) {
        study::Place const p = study::place_of_setting(text, key, value);
        return fmt::format("{}:{}", p.line, p.column);
    };
    EXPECT_EQ(at("ar.frame", "2"), "2:39");
    EXPECT_EQ(at("ar.render.paths", "4"), "3:24");
    EXPECT_EQ(at("ar", "s.yaml"), "4:27");
    EXPECT_EQ(at("ar.light.scale", "0.5"), "6:23");
    EXPECT_EQ(at("ar", "t.yaml"), "0:0");
}

} // namespace
} // namespace viewer::test
