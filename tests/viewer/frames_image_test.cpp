// `lightwell render --frames`: every frame is the picture that --time gives alone, whatever interrupts them.

#include "gi/image_io/picture_file.h"
#include "gi/metrics/compare.h"
#include "tests/viewer/run_program.h"

#include <nlohmann/json.hpp>
#include <opencv2/videoio.hpp>

namespace viewer::test {
namespace {

using Json = nlohmann::json;

bool contains(std::string const& text, std::string const& part) { return text.find(part) != std::string::npos; }

Json json_file(std::filesystem::path const& file) { return Json::parse(file_text(file)); }

/// The first difference of two pictures' layers; empty = none.
std::string difference(std::filesystem::path const& a, std::filesystem::path const& b)
{
    gi::Picture const p = gi::read_picture(a), q = gi::read_picture(b);
    if (p.layers.size() != q.layers.size()) return "layers";
    for (std::size_t i = 0; i < p.layers.size(); ++i)
        if (p.layers[i].name != q.layers[i].name || p.layers[i].data != q.layers[i].data) return p.layers[i].name;
    return {};
}

int frames_of_video(std::filesystem::path const& file, cv::Size size)
{
    cv::VideoCapture in(file.string(), cv::CAP_FFMPEG);
    int frames = 0;
    for (cv::Mat image; in.read(image); ++frames) EXPECT_EQ(image.size(), size);
    return frames;
}

/// Of 32 x 24 pixels; hit buffers of few directions, as they are built for each moment.
std::string small_pictures_by(std::string const& method)
{
    return " --size 32x24 --camera gallery --method " + method +
           (method == "slhb" ? " --directions icosahedron:20 --hit-buffer 32" : "");
}

/// A frame's own words make it again, alone.
void expect_to_be_made_alone(TemporaryFolder const& folder, std::string const& frame, std::string const& more = "")
{
    run_well(gi::read_picture(folder / frame).metadata.at("command").substr(10) + " --out one.exr" + more,
             folder.path());
    EXPECT_EQ(difference(folder / frame, folder / "one.exr"), "");
}

TEST(Frames, AreThePicturesOfTheirTimes)
{
    TemporaryFolder const folder;
    for (std::string const method : {"reference", "paths", "slhb"}) {
        Outcome const o = run_well("render atrium --frames 3:5@7 --paths 2 --out f_%02d.exr --png f_%d.png" +
                                       small_pictures_by(method),
                                   folder.path());
        EXPECT_TRUE(contains(o.out, "f_03.exr ... f_04.exr\n")) << o.out;
        EXPECT_TRUE(contains(o.out, "2 frames of 32 x 24 pixels")) << o.out;
        for (int k = 3; k < 5; ++k) {
            std::string const name = "f_0" + std::to_string(k) + ".exr";
            EXPECT_EQ(gi::read_picture(folder / name).metadata.at("frame"), std::to_string(k));
            expect_to_be_made_alone(folder, name, " --png one.png");
            EXPECT_EQ(file_text(folder / ("f_" + std::to_string(k) + ".png")), file_text(folder / "one.png"));
        }
        EXPECT_NE(difference(folder / "f_03.exr", folder / "f_04.exr"), "") << "the figure walks";
    }
}

/// Blurred by motion, too, and an interruption changes nothing.
TEST(Frames, AreThePicturesOfTheirShutters)
{
    for (std::string const method : {"reference", "paths", "slhb"}) {
        TemporaryFolder const folder;
        std::string const how = " --paths 4" + small_pictures_by(method);
        std::string const call = "render atrium --frames 3:5@7 --out f_%d.exr --shutter 0.1" + how;
        run_well(call, folder.path());
        expect_to_be_made_alone(folder, "f_3.exr");
        std::string const kept = file_text(folder / "f_4.exr");
        std::filesystem::remove(folder / "f_4.exr");
        run_well(call + " --resume", folder.path());
        EXPECT_TRUE(file_text(folder / "f_4.exr") == kept);
        run_well("render atrium --frames 3:4@7 --out sharp_%d.exr --stats a.json" + how, folder.path());
        EXPECT_NE(difference(folder / "f_3.exr", folder / "sharp_3.exr"), "") << "the figure walks";
        EXPECT_EQ(json_file(folder / "a.json")["settings"]["shutter_s"], 0);
        run_well("render atrium --frames 3:4@7 --shutter 0 --out closed_%d.exr" + how, folder.path());
        EXPECT_TRUE(file_text(folder / "closed_3.exr") == file_text(folder / "sharp_3.exr"));
    }
}

/// A budget is that of the one picture: nothing is built to last for more.
TEST(Frames, ABudgetIsThatOfOneExposure)
{
    TemporaryFolder const folder;
    std::string const call = "render atrium --time 0.4 --shutter 0.04 --size 16x16 --method slhb --out e.exr ";
    auto const lasts = [&] {
        return contains(gi::read_picture(folder / "e.exr").metadata.at("command"), "--fresh-light-samples");
    };
    run_well(call + "--paths 2", folder.path());
    EXPECT_TRUE(lasts());
    run_well(call + "--budget 500ms", folder.path());
    EXPECT_FALSE(lasts());
}

/// The camera's motion blurs, and without any the shutter does nothing and says so.
TEST(Frames, OfWhatStandsStillHaveNoShutter)
{
    TemporaryFolder const folder;
    std::string const call = "render cornell --size 24x24 --paths 4 --method paths ";
    Outcome const o = run_well(call + "--time 0 --shutter 1 --out open.exr", folder.path());
    EXPECT_TRUE(contains(o.err, "--shutter does nothing")) << o.err;
    run_well(call + "--time 0 --out closed.exr", folder.path());
    EXPECT_EQ(difference(folder / "open.exr", folder / "closed.exr"), "");

    run_well(call + "--frames 0:2@8 --turntable 90deg --shutter 0.1 --out open_%d.exr", folder.path());
    run_well(call + "--frames 0:2@8 --turntable 90deg --out closed_%d.exr", folder.path());
    EXPECT_NE(difference(folder / "open_0.exr", folder / "closed_0.exr"), "");
}

/// Layers are gathered over the exposure if only the camera moves; where a figure walks as well, a path has one moment.
TEST(Frames, AreGatheredOverTheShutterIfOnlyTheCameraMoves)
{
    TemporaryFolder const folder;
    std::string const call = "render atrium --size 24x16 --paths 2 --radiance-cache off --frames 0:1@8 "
                             "--turntable 90deg --shutter 0.1 ";
    for (std::string const time : {"", "--time 0.4 "}) {
        run_well(call + time + "--method paths --out sampled_%d.exr", folder.path());
        run_well(call + time + "--method paths_layered_lens --out gathered_%d.exr", folder.path());
        EXPECT_EQ(difference(folder / "sampled_0.exr", folder / "gathered_0.exr").empty(), time.empty());
        std::filesystem::remove(folder / "sampled_0.exr");
        std::filesystem::remove(folder / "gathered_0.exr");
    }
}
/// The camera is where it was as each shutter opens, but goes round half as fast.
TEST(Frames, OfAnotherMotionAreKept)
{
    TemporaryFolder const folder;
    std::string const call =
        "render cornell --size 16x16 --paths 2 --turntable --time 0 --shutter 0.04 --out f_%d.exr --frames 0:3";
    run_well(call + "@24", folder.path());
    Outcome const other = run(call + "@12 --resume", folder.path());
    EXPECT_EQ(other.code, 2);
    EXPECT_TRUE(contains(other.err, "its motion blur differs")) << other.err;
    Outcome const same = run_well(call + "@24 --resume", folder.path());
    EXPECT_TRUE(contains(same.out, "3 existed already")) << same.out;
}

/// Two triangles that lie apart; one of them has no area in the last two frames.
void write_collapsing(std::filesystem::path const& folder, double x, int frames)
{
    std::filesystem::create_directory(folder);
    for (int k = 0; k < frames; ++k) {
        double const s = x + 0.25 * k, height = k + 2 < frames ? 1.0 : 0.0;
        std::ofstream(folder / ("f_" + std::to_string(k) + ".obj"))
            << "v " << s << " 0 0\nv " << s + 1 << " 0 0\nv " << s << " 1 0\n"
            << "v " << s << " 0 2\nv " << s + 1 << " 0 2\nv " << s << " " << height << " 2\n"
            << "f 1 2 3\nf 4 5 6\n";
    }
}

TEST(Frames, ReportTrianglesThatCollapse)
{
    TemporaryFolder const folder;
    write_collapsing(folder / "s", 0, 4);
    std::string const what = "moved so that they have no area, or are not finite: 1";
    std::string const call = "render s --method paths --size 8x8 ";
    Outcome const reused = run_well(call + "--paths 2 --frames 0:3@24 --reuse 4 --out r_%d.exr", folder.path());
    EXPECT_TRUE(contains(reused.err, what)) << reused.err;
    // Passes are of moments all over the shutter; from 2/24 to 3/24 s there is no area.
    Outcome const exposed = run_well(call + "--paths 16 --time 0 --shutter 0.12 --out e.exr", folder.path());
    EXPECT_TRUE(contains(exposed.err, what)) << exposed.err;
    Outcome const timed = run_well("bench dynamic --scene s --frames 3 --fps 24 --size 8x8 --structures appended "
                                   "--reference-paths 0 --out d",
                                   folder.path());
    EXPECT_TRUE(contains(timed.err, what)) << timed.err;
}

double relmse(std::filesystem::path const& picture, std::filesystem::path const& truth)
{
    return gi::compare(gi::read_picture(picture), gi::read_picture(truth), {"relmse"}, "color")
        .values.front()
        .value;
}

/// A frame that is missing has the light of those before it, which are there.
TEST(Frames, ResumedHaveWhatTheyReuse)
{
    TemporaryFolder const folder;
    std::string const how = "render cornell --method paths --bounces 2 --size 32x32 ";
    std::string const call = how + "--paths 1 --frames 0:6@24 --reuse 6 --out f_%d.exr";
    run_well(how + "--paths 256 --seed 1 --out truth.exr", folder.path());
    run_well(call, folder.path());
    std::string const kept = file_text(folder / "f_4.exr");
    double const whole = relmse(folder / "f_5.exr", folder / "truth.exr"),
                 alone = relmse(folder / "f_0.exr", folder / "truth.exr");
    std::filesystem::remove(folder / "f_5.exr");
    Outcome const o = run_well(call + " --resume", folder.path());
    EXPECT_TRUE(contains(o.err, "5 existing frames are rendered again but not saved")) << o.err;
    EXPECT_TRUE(file_text(folder / "f_4.exr") == kept);
    double const resumed = relmse(folder / "f_5.exr", folder / "truth.exr");
    EXPECT_LT(resumed, 0.5 * alone);
    EXPECT_LT(resumed, 1.5 * whole);
    Outcome const complete = run_well(call + " --resume", folder.path());
    EXPECT_FALSE(contains(complete.err, "again")) << complete.err;
}

/// All frames of a render with reuse have one origin, that of the first.
TEST(Frames, FarFromZeroResumeWithReuse)
{
    TemporaryFolder const folder;
    write_collapsing(folder / "far", 5000, 4);
    std::string const call =
        "render far --method paths --size 8x8 --paths 1 --frames 0:3@24 --reuse 2 --out f_%d.exr";
    run_well(call, folder.path());
    std::filesystem::remove(folder / "f_2.exr");
    Outcome const o = run_well(call + " --resume", folder.path());
    EXPECT_TRUE(contains(o.out, "2 existed already")) << o.out;
}

TEST(Frames, OfACameraPathAreThePicturesOfTheirTimes)
{
    TemporaryFolder const folder;
    std::string const how =
        " --size 24x16 --paths 1 --camera-path " LIGHTWELL_SOURCE_DIR "/data/camera_path.yaml ";
    run_well("render atrium --frames 0:4@1 --out f_%d.exr" + how, folder.path());
    run_well("render atrium --time 3 --out one.exr" + how, folder.path());
    EXPECT_EQ(difference(folder / "f_3.exr", folder / "one.exr"), "");
    EXPECT_NE(difference(folder / "f_2.exr", folder / "one.exr"), "");
}

TEST(Frames, HaveOneSeedOrEachItsOwn)
{
    TemporaryFolder const folder;
    run_well("render cornell --size 16x16 --paths 1 --frames 0:2@1 --out same_%d.exr", folder.path());
    run_well("render cornell --size 16x16 --paths 1 --frames 0:2@1 --seed-per-frame --out own_%d.exr",
             folder.path());
    EXPECT_EQ(difference(folder / "same_0.exr", folder / "same_1.exr"), "");
    EXPECT_EQ(difference(folder / "own_0.exr", folder / "same_0.exr"), "");
    EXPECT_NE(difference(folder / "own_0.exr", folder / "own_1.exr"), "");
}

TEST(Frames, ATurntableComesRoundWithoutAFrameTwice)
{
    TemporaryFolder const folder;
    std::string const how = "render cornell --size 16x16 --paths 1 --look-from 0.3,0.3,0.9 --look-at 0.3,0.3,0.3 ";
    run_well(how + "--frames 0:4@1 --turntable --out f_%d.exr", folder.path());
    run_well(how + "--frames 0:8@1 --turntable 2 --out two_%d.exr", folder.path());
    run_well("render cornell --size 16x16 --paths 1 --look-from 0.9,0.3,0.3 --look-at 0.3,0.3,0.3 --out side.exr",
             folder.path());
    auto const mean_depth = [&](std::string const& name) {
        double sum = 0;
        gi::Picture const picture = gi::read_picture(folder / name);
        for (float const v : picture.find("depth")->data) sum += std::isfinite(v) ? double(v) : 0.0;
        return sum;
    };
    EXPECT_NEAR(mean_depth("f_1.exr") / mean_depth("side.exr"), 1, 1e-3) << "a quarter round";
    for (int k = 0; k < 4; ++k)
        EXPECT_NEAR(mean_depth("f_" + std::to_string(k) + ".exr") /
                        mean_depth("two_" + std::to_string(k + 4) + ".exr"),
                    1, 1e-3);
    EXPECT_GT(std::abs(mean_depth("f_0.exr") / mean_depth("f_1.exr") - 1), 1e-3);
}

TEST(Frames, GiveAVideo)
{
    TemporaryFolder const folder;
    run_well("render cornell --size 32x24 --paths 1 --frames 0:5@25 --turntable --png f_%d.png --video a.mkv "
             "--exposure 1 --tone filmic",
             folder.path());
    EXPECT_EQ(folder.files(),
              (std::vector<std::string>{"a.mkv", "f_0.png", "f_1.png", "f_2.png", "f_3.png", "f_4.png"}));
    EXPECT_EQ(frames_of_video(folder / "a.mkv", {32, 24}), 5);
    cv::VideoCapture in((folder / "a.mkv").string(), cv::CAP_FFMPEG);
    EXPECT_NEAR(in.get(cv::CAP_PROP_FPS), 25, 1e-6);
    cv::Mat image;
    for (int k = 0; k < 5 && in.read(image); ++k) {
        gi::Picture const png = gi::read_picture(folder / ("f_" + std::to_string(k) + ".png"));
        // Byte 255 is 1, and so on: equal bytes have equal linear values.
        for (int i : {0, 100, 32 * 24 - 1}) {
            float const v = png.find("color")->data[std::size_t(3 * i)];
            float const s = float(image.data[3 * i + 2]) / 255;
            EXPECT_NEAR(v, s <= 0.04045f ? s / 12.92f : std::pow((s + 0.055f) / 1.055f, 2.4f), 1e-6f);
        }
    }
    run_well("render cornell --size 32x24 --paths 1 --frames 0:5@25 --video a.mp4", folder.path());
    EXPECT_EQ(frames_of_video(folder / "a.mp4", {32, 24}), 5);
}

TEST(Frames, HaveARecordEach)
{
    TemporaryFolder const folder;
    std::string const call = "render cornell --size 16x16 --paths 2 --frames 0:4@8 --out f_%d.exr --stats s.json";
    run_well(call, folder.path());
    Json const stats = json_file(folder / "s.json");
    ASSERT_EQ(stats.at("frames").size(), 4u);
    for (int k = 0; k < 4; ++k) {
        Json const& f = stats.at("frames").at(std::size_t(k));
        EXPECT_EQ(f.at("frame"), k);
        EXPECT_EQ(f.at("time_s"), k / 8.0);
        EXPECT_EQ(f.at("exr"), "f_" + std::to_string(k) + ".exr");
        EXPECT_EQ(f.at("paths_per_pixel"), 2);
        EXPECT_GT(f.at("seconds").get<double>(), 0);
        EXPECT_FALSE(f.at("reused").get<bool>());
    }
    Json const& seconds = stats.at("frame_seconds");
    EXPECT_LE(seconds.at("median"), seconds.at("p95"));
    EXPECT_LE(seconds.at("p95"), seconds.at("p99"));

    run_well(call + " --resume", folder.path());
    Json const again = json_file(folder / "s.json");
    for (Json const& f : again.at("frames")) EXPECT_TRUE(f.at("reused").get<bool>());
    EXPECT_TRUE(again.at("frame_seconds").is_null());
}

TEST(Frames, SayWhichMethodWasChosen)
{
    TemporaryFolder const folder;
    for (char const* const reuse : {"", " --reuse 2"}) {
        run_well("render cornell --size 8x8 --paths 1 --frames 0:2@8 --turntable --out f_%d.exr --stats s.json" +
                     std::string(reuse),
                 folder.path());
        Json const stats = json_file(folder / "s.json"), settings = stats.at("settings");
        EXPECT_EQ(settings.at("method"), "auto");
        EXPECT_EQ(settings.at("chosen_method"), "paths") << reuse;
        EXPECT_TRUE(contains(settings.at("chosen_method_because"), "exact rays")) << settings;
        EXPECT_TRUE(contains(stats.at("command"), "--method paths")) << stats.at("command");
        auto const facts = gi::read_exr(folder / "f_1.exr").metadata;
        EXPECT_EQ(facts.at("method"), "paths") << reuse;
        EXPECT_EQ(facts.at("asked_method"), "auto");
    }
}

constexpr int kFrames = 10;
constexpr char const* kLong =
    "render cornell --size 32x32 --paths 16 --seed-per-frame --threads 1 --quiet --frames "
    "0:10@30 --turntable 15deg --out f_%02d.exr --video a.mkv";
constexpr char const* kState = "f_00-09.exr.state";

/// Starts it and sends the signal once some frames are there: it comes while another one is rendered or written, or
/// after the last one. tests/viewer/interrupted_frames_test.cpp interrupts at every moment.
Outcome interrupt(TemporaryFolder const& folder, int signal)
{
    Program program(words(kLong), folder.path());
    while (program.runs() && !std::filesystem::exists(folder / "f_02.exr"))
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    program.send(signal);
    return program.wait();
}

void expect_whole(TemporaryFolder const& folder)
{
    static TemporaryFolder const undisturbed;
    if (undisturbed.files().empty()) run_well(kLong, undisturbed.path());
    EXPECT_EQ(folder.files(), undisturbed.files());
    for (std::string const& name : undisturbed.files())
        if (name.ends_with(".exr")) {
            EXPECT_TRUE(file_text(folder / name) == file_text(undisturbed / name)) << name;
        }
    EXPECT_EQ(frames_of_video(folder / "a.mkv", {32, 32}), kFrames);
    // Matroska writes a random id, so that videos are compared by what they show.
    cv::VideoCapture a((folder / "a.mkv").string()), b((undisturbed / "a.mkv").string());
    for (cv::Mat p, q; a.read(p) && b.read(q);) EXPECT_EQ(cv::norm(p, q, cv::NORM_INF), 0);
}

TEST(Frames, ControlCKeepsWhatIsCompleteAndResumeGoesOn)
{
    TemporaryFolder const folder;
    Outcome const o = interrupt(folder, SIGINT);
    int frames = 0;
    for (std::string const& name : folder.files())
        if (name.ends_with(".exr")) {
            EXPECT_NO_THROW(gi::read_picture(folder / name)) << name;
            ++frames;
        }
    EXPECT_EQ(frames_of_video(folder / "a.mkv", {32, 32}), frames);
    if (frames < kFrames) {
        EXPECT_EQ(o.code, 130) << o.err;
        EXPECT_TRUE(contains(o.err, std::to_string(frames) + " of 10 frames")) << o.err;
        EXPECT_TRUE(contains(o.err, "--resume")) << o.err;
        EXPECT_TRUE(contains(o.err, "contains the frames so far")) << o.err;
        EXPECT_TRUE(std::filesystem::exists(folder / kState));
        Outcome const afresh = run(kLong, folder.path());
        EXPECT_EQ(afresh.code, 2) << "would replace what is unfinished";
        EXPECT_TRUE(contains(afresh.err, "--resume")) << afresh.err;
    }
    auto const time = std::filesystem::last_write_time(folder / "f_00.exr");
    Outcome const resumed = run_well(std::string(kLong) + " --resume", folder.path());
    EXPECT_TRUE(contains(resumed.out, std::to_string(frames) + " existed already")) << resumed.out;
    EXPECT_EQ(std::filesystem::last_write_time(folder / "f_00.exr"), time);
    expect_whole(folder);
}

TEST(Frames, AKilledRenderResumesToo)
{
    TemporaryFolder const folder;
    interrupt(folder, SIGKILL);
    std::string const part = file_text(folder / "f_01.exr").substr(0, 2000);
    std::ofstream(folder / "f_01.exr", std::ios::binary) << part;
    Outcome const o = run_well(std::string(kLong) + " --resume", folder.path());
    EXPECT_TRUE(contains(o.err, "damaged, rendered again: 1 (first: f_01.exr)")) << o.err;
    for (std::string const& name : folder.files()) // what was half-written when it was killed
        if (name.starts_with(".f_")) std::filesystem::remove(folder / name);
    expect_whole(folder);
}

TEST(Frames, OfAnotherRenderAreKept)
{
    TemporaryFolder const folder;
    std::string const call =
        "render cornell --size 16x16 --paths 1 --frames 0:3@30 --turntable --out f_%d.exr --resume ";
    Outcome const o = run_well(call, folder.path());
    EXPECT_TRUE(contains(o.err, "only missing frames")) << o.err;
    std::string const before = file_text(folder / "f_0.exr");
    struct Other {
        char const *option, *why;
    };
    for (Other const other : {Other{"--seed 1", "its seed is 0, not 1"},
                              {"--bounces 2", "its bounces is 64, not 2"},
                              {"--method paths", "its method is auto, not paths"},
                              {"--paths 2", "its stop is --paths 1, not --paths 2"},
                              {"--size 8x8", "its size is 16x16, not 8x8"},
                              {"--shutter 0.1", "its shutter is 0, not 0.1"},
                              {"--half", "its numbers is single, not half"},
                              {"--fov 20", "its scene, camera or settings differ"}}) {
        std::string changed = call;
        if (std::string(other.option).starts_with("--paths")) changed.replace(changed.find("--paths 1"), 9, "");
        if (std::string(other.option).starts_with("--size")) changed.replace(changed.find("--size 16x16"), 12, "");
        Outcome const refused = run(changed + other.option, folder.path());
        EXPECT_EQ(refused.code, 2) << other.option;
        EXPECT_TRUE(contains(refused.err, other.why)) << refused.err;
    }
    EXPECT_TRUE(file_text(folder / "f_0.exr") == before);
    EXPECT_EQ(folder.files().size(), 3u) << testing::PrintToString(folder.files());
    // Only the display changes: the frames stay, their pictures are made from them.
    run_well(call + "--png f_%d.png --exposure 1", folder.path());
    EXPECT_TRUE(file_text(folder / "f_0.exr") == before);
    EXPECT_EQ(folder.files().size(), 6u);
}

} // namespace
} // namespace viewer::test
