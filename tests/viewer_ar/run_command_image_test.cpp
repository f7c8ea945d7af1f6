// Whole sessions through the program: what is true is known of every frame.

#include "ar/pose/pose_file.h"
#include "tests/viewer/run_program.h"

#include <cmath>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>

namespace viewer::test {
namespace {

namespace fs = std::filesystem;

cv::Mat picture(fs::path const& file) { return cv::imread(file.string(), cv::IMREAD_COLOR); }

void write(fs::path const& file, std::string const& text) { std::ofstream(file) << text; }

/// A number behind these words, on the line that begins so.
double number_behind(std::string const& text, std::string const& words, int column = 0)
{
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);) {
        if (!line.starts_with(words)) continue;
        std::istringstream values(line.substr(words.size()));
        double value = std::numeric_limits<double>::quiet_NaN();
        for (int i = 0; i <= column; ++i)
            if (!(values >> value)) return std::numeric_limits<double>::quiet_NaN();
        return value;
    }
    return std::numeric_limits<double>::quiet_NaN();
}

/// Three frames of the camera, with what they would be with the things there.
class ArRuns : public testing::Test {
protected:
    static void SetUpTestSuite()
    {
        made_ = std::make_unique<TemporaryFolder>();
        run_well("ar synthesize desk --frames 3 --size 160x120 --paths 6", made_->path());
    }
    static void TearDownTestSuite() { made_.reset(); }
    ArRuns() { fs::copy(*made_ / "desk", desk(), fs::copy_options::recursive); }

    fs::path desk() const { return folder_ / "desk"; }
    std::string session() const { return file_text(desk() / "session.yaml"); }
    /// With nothing virtual, whose light takes most of the time.
    std::string empty_session() const
    {
        std::string text = session();
        std::size_t const at = text.find("virtual:");
        return text.erase(at, text.find('\n', at) + 1 - at);
    }
    Outcome run(std::string const& command) const { return viewer::test::run(command, desk()); }

    static inline std::unique_ptr<TemporaryFolder> made_;
    TemporaryFolder folder_;
};

TEST_F(ArRuns, WithNothingVirtualGiveTheCamerasFrames)
{
    write(desk() / "empty.yaml", empty_session());
    Outcome const o = run("ar run empty.yaml --fast --poses poses.csv --out unchanged --table t.csv");
    ASSERT_EQ(o.code, 0) << o.err;
    for (int f = 0; f < 3; ++f) {
        std::string const name = fmt::format("{:06}.png", f);
        EXPECT_EQ(cv::norm(picture(desk() / "frames" / name), picture(desk() / "unchanged" / name), cv::NORM_INF),
                  0);
    }
    EXPECT_NE(o.out.find("camera found in 3 (100.0 %)"), std::string::npos) << o.out;
}

TEST_F(ArRuns, AreNearTheTruth)
{
    Outcome const o = run("ar run session.yaml --fast --poses poses.csv --truth truth");
    ASSERT_EQ(o.code, 0) << o.err;
    double const inside = number_behind(o.out, "FLIP where it is affected"),
                 elsewhere = number_behind(o.out, "FLIP elsewhere"),
                 nothing = number_behind(o.out, "  of adding nothing");
    fmt::print("FLIP {:.3f} where it is affected ({:.3f} of adding nothing), {:.4f} elsewhere\n", inside, nothing,
               elsewhere);
    // Six paths for the truth and four for the composite: most of it is noise.
    EXPECT_LT(inside, 0.6 * nothing);
    EXPECT_LT(elsewhere, 0.03);
}

TEST_F(ArRuns, PairLostFramesWithTheirOwnTruth)
{
    fs::remove(desk() / "frames/000001.png");
    Outcome const o =
        run("ar run session.yaml --fast --poses poses.csv --truth truth --table t.csv --stats s.json");
    ASSERT_EQ(o.code, 0) << o.err;
    EXPECT_NE(o.out.find("2 frames, 1 dropped (not there: 1)"), std::string::npos) << o.out;
    EXPECT_NE(o.err.find("numbered pictures that are not there: 1 (first: number 1)"), std::string::npos) << o.err;
    std::string const table = file_text(desk() / "t.csv");
    EXPECT_NE(table.find("\n2,0.066667,"), std::string::npos) << table;
    EXPECT_LT(number_behind(o.out, "FLIP elsewhere"), 0.03);
    auto const stats = nlohmann::json::parse(file_text(desk() / "s.json"));
    EXPECT_EQ(stats["losses"]["numbered pictures that are not there"]["count"], 1);
    EXPECT_EQ(stats["truth"]["frames_compared"], 2);

    // Without the first one the session's `first` says which time the others have.
    fs::remove(desk() / "frames/000000.png");
    Outcome const last = run("ar run session.yaml --fast --poses poses.csv --true-poses poses.csv --table t.csv");
    ASSERT_EQ(last.code, 0) << last.err;
    EXPECT_NE(file_text(desk() / "t.csv").find("\n2,0.066667,"), std::string::npos);
    EXPECT_NE(last.out.find("2 of them before the first frame"), std::string::npos) << last.out;
    EXPECT_LT(number_behind(last.out, "position error (mm)"), 1e-6);

    std::string text = session();
    text.erase(text.find(", first: 0"), 10);
    write(desk() / "other.yaml", text);
    Outcome const other = run("ar run other.yaml --fast --poses poses.csv");
    EXPECT_NE(other.err.find("frames: {first: 0}"), std::string::npos) << other.err;
}

TEST_F(ArRuns, OfAWrongTruthHaveNoErrors)
{
    Outcome const o = run("ar run session.yaml --fast --poses poses.csv --truth frames --stats s.json");
    ASSERT_EQ(o.code, 0) << o.err;
    EXPECT_TRUE(std::isnan(number_behind(o.out, "FLIP where it is affected"))) << o.out;
    EXPECT_NE(o.out.find("no pixel is affected in 3 of 3 frames: their truth is the camera's frame"),
              std::string::npos)
        << o.out;
    EXPECT_NE(o.err.find("in which the truth affects no pixel"), std::string::npos) << o.err;
    auto const stats = nlohmann::json::parse(file_text(desk() / "s.json"));
    EXPECT_TRUE(stats["truth"]["flip_affected"].is_null());
    EXPECT_EQ(stats["truth"]["frames_equal_to_the_camera"], 3);

    fs::remove(desk() / "truth/000001.png");
    cv::imwrite((desk() / "truth/000002.png").string(), cv::Mat(8, 8, CV_8UC3, cv::Scalar(0)));
    Outcome const some = run("ar run session.yaml --fast --poses poses.csv --truth truth");
    EXPECT_NE(some.out.find("no truth picture: 1 frames (first: frame 1)"), std::string::npos) << some.out;
    EXPECT_NE(some.out.find("cannot be compared: 1 (first: frame 2: '000002.png' has 8 x 8"), std::string::npos)
        << some.out;
    EXPECT_EQ(some.err.find("imread"), std::string::npos) << some.err;

    fs::create_directories(desk() / "none");
    EXPECT_EQ(run("ar run session.yaml --fast --truth none").code, 2);
    write(desk() / "later.csv", "time_s,x_m,y_m,z_m,qx,qy,qz,qw\n9,0,0,0,0,0,0,1\n");
    Outcome const later = run("ar run session.yaml --fast --poses poses.csv --true-poses later.csv");
    EXPECT_NE(later.out.find("no true pose at their time: 3 frames"), std::string::npos) << later.out;
    EXPECT_TRUE(std::isnan(number_behind(later.out, "position error (mm)"))) << later.out;
}

TEST_F(ArRuns, SayWhyNothingVirtualIsSeen)
{
    for (auto const& [at_m, words] : std::vector<std::pair<std::string, std::string>>{
             {"[0, 0, 40]", "behind the camera in 3"},
             {"[-0.02, 0, -0.1], scale: 0.001", "smaller than 4 pixels in 3"},
             {"[4, 0, -1]", "outside of the picture in 3"}}) {
        std::string text = session();
        std::size_t const at = text.find("at: [");
        text.replace(at, text.find(']', at) + 1 - at, "at: " + at_m);
        write(desk() / "unseen.yaml", text);
        Outcome const o = run("ar run unseen.yaml --fast --poses poses.csv");
        EXPECT_EQ(o.code, 0) << o.err;
        EXPECT_NE(o.err.find("in doubt: composites that show nothing virtual: 3"), std::string::npos)
            << at_m << o.err;
        EXPECT_NE(o.err.find("the virtual objects are " + words), std::string::npos) << at_m << o.err;
    }
    EXPECT_EQ(run("ar run session.yaml --fast --poses poses.csv").err, "");
    write(desk() / "none.yaml", empty_session());
    EXPECT_EQ(run("ar run none.yaml --fast --poses poses.csv").err, "") << "nothing virtual was asked for";
}

TEST_F(ArRuns, WithoutLightSayThatObjectsAreBlack)
{
    std::string text = session();
    std::size_t const at = text.find("light:");
    ASSERT_NE(at, std::string::npos);
    write(desk() / "dark.yaml", text.erase(at, text.find('\n', at) + 1 - at));
    Outcome const o = run("ar run dark.yaml --fast --poses poses.csv --frames 1");
    EXPECT_EQ(o.code, 0) << o.err;
    EXPECT_NE(o.err.find("sessions without any light, whose virtual objects are black: 1"), std::string::npos)
        << o.err;
}

TEST_F(ArRuns, FollowTheLight)
{
    std::string text = session();
    text.replace(text.find("probe.exr}"), 10, "probe.exr, live: 1}");
    write(desk() / "live.yaml", text);
    Outcome const o = run("ar run live.yaml --fast --poses poses.csv --truth truth");
    ASSERT_EQ(o.code, 0) << o.err;
    EXPECT_NE(o.out.find("light (ms)"), std::string::npos);
    // The place is as it was when the map was made.
    EXPECT_LT(number_behind(o.out, "FLIP where it is affected"),
              0.7 * number_behind(o.out, "  of adding nothing"));
}

TEST(ArTracking, FindsTheCamera)
{
    TemporaryFolder folder;
    run_well("ar synthesize desk --frames 1 --size 640x480 --paths 1 --no-truth", folder.path());
    Outcome const o =
        run("ar track desk/session.yaml --fast --true-poses desk/poses.csv --require-found 100% --table t.csv",
            folder.path());
    ASSERT_EQ(o.code, 0) << o.err;
    EXPECT_NE(o.out.find("camera found in 1 (100.0 %)"), std::string::npos) << o.out;
    double const mm = number_behind(o.out, "position error (mm)", 2),
                 deg = number_behind(o.out, "rotation error (deg)", 2);
    fmt::print("camera: {:.2f} mm, {:.3f} degrees\n", mm, deg);
    EXPECT_LT(mm, 3);
    EXPECT_LT(deg, 0.2);
    std::string const table = file_text(folder / "t.csv");
    EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 2);
}

TEST_F(ArRuns, WithoutMarkersPassFramesOn)
{
    write(desk() / "other.yaml", "markers:\n  - {dictionary: DICT_6X6_50, id: 40, side_m: 0.1}\n");
    std::string text = session();
    text.replace(text.find("markers.yaml"), 12, "other.yaml");
    write(desk() / "blind.yaml", text);
    Outcome const o = run("ar run blind.yaml --fast --out blind");
    EXPECT_EQ(o.code, 1) << "scripts must notice";
    EXPECT_NE(o.err.find("the camera was found in none of 3 frames"), std::string::npos) << o.err;
    EXPECT_NE(o.out.find("poses: 3 lost"), std::string::npos) << o.out;
    EXPECT_EQ(run("ar run blind.yaml --fast --require-found 0%").code, 0) << "as asked for";
    EXPECT_NE(o.out.find("camera found in 0 (0.0 %)"), std::string::npos) << o.out;
    EXPECT_EQ(cv::norm(picture(desk() / "frames/000001.png"), picture(desk() / "blind/000001.png"), cv::NORM_INF),
              0);
}

TEST_F(ArRuns, HoldAndFadeWhereThereIsNoPose)
{
    std::string const poses = file_text(desk() / "poses.csv");
    std::size_t const second = poses.find('\n', poses.find('\n') + 1) + 1;
    write(desk() / "first.csv", poses.substr(0, second)); // 1/30 s a frame: only the first one's pose is known
    auto const with = [&](std::string const& name, std::string const& keys) {
        write(desk() / (name + ".yaml"), session() + "pose: {" + keys + "}\n");
        Outcome const o =
            run("ar run " + name + ".yaml --fast --poses first.csv --out " + name + " --table " + name + ".csv");
        EXPECT_EQ(o.code, 0) << o.err;
        return o.out;
    };
    auto const change = [&](std::string const& name, int frame) {
        std::string const file = fmt::format("{:06}.png", frame);
        return cv::norm(picture(desk() / "frames" / file), picture(desk() / name / file), cv::NORM_L1);
    };
    EXPECT_NE(with("at_once", "hold_s: 0, fade_s: 0").find("poses: 1 tracked, 2 lost"), std::string::npos);
    EXPECT_EQ(change("at_once", 1) + change("at_once", 2), 0) << "the camera's bytes";
    EXPECT_NE(with("fading", "hold_s: 0.04, fade_s: 0.05").find("poses: 1 tracked, 1 held, 1 fading"),
              std::string::npos);
    EXPECT_NE(with("held", "hold_s: 1").find("poses: 1 tracked, 2 held"), std::string::npos);
    EXPECT_EQ(change("fading", 1), change("held", 1));
    double const share = change("fading", 2) / change("held", 2);
    EXPECT_NEAR(share, 0.5, 0.2) << "0.467 of the light; bytes are not linear in it";
    EXPECT_NE(file_text(desk() / "fading.csv").find(",fading,0.467"), std::string::npos);
}

TEST_F(ArRuns, TimeNumberedPosesAsTheirSource)
{
    // A video of 24 Hz in a session that says nothing of it; poses as of COLMAP, and by their times.
    std::string const frames = "source: frames, rate_hz: 30";
    auto const with = [&](std::string const& source) {
        std::string text = empty_session();
        return text.replace(text.find(frames), frames.size(), source);
    };
    write(desk() / "slow.yaml", with("source: frames, rate_hz: 24"));
    ASSERT_EQ(run("ar run slow.yaml --fast --poses poses.csv --video slow.mkv").code, 0);
    write(desk() / "video.yaml", with("source: slow.mkv"));
    std::vector<ar::TimedPose> poses = ar::read_poses(desk() / "poses.csv", {30}).poses;
    auto const image = [&](int k) {
        gi::RigidPose const p = inverse(poses[std::size_t(k)].world_from_camera);
        glm::dquat const q = p.rotation;
        return fmt::format("{} {} {} {} {} {} {} {} 1 {:03}.png\n\n", k + 1, q.w, q.x, q.y, q.z, p.position.x,
                           p.position.y, p.position.z, k + 7);
    };
    write(desk() / "all.txt", image(0) + image(1) + image(2));
    write(desk() / "late.txt", image(1) + image(2)); // the first picture could not be registered
    for (int k = 0; k < 3; ++k) poses[std::size_t(k)].time_s = k / 24.0;
    write(desk() / "timed.csv", ar::format_poses(poses));
    Outcome const all = run("ar run video.yaml --fast --poses all.txt --true-poses timed.csv");
    ASSERT_EQ(all.code, 0) << all.err;
    EXPECT_NE(all.out.find("poses: 3 tracked"), std::string::npos) << all.out;
    EXPECT_LT(number_behind(all.out, "position error (mm)", 2), 0.01);
    EXPECT_NE(all.err.find("taken for number 7 of 'all.txt'"), std::string::npos) << all.err;
    Outcome const truth = run("ar run video.yaml --fast --poses timed.csv --true-poses all.txt");
    EXPECT_LT(number_behind(truth.out, "position error (mm)", 2), 0.01);
    Outcome const late = run("ar run video.yaml --fast --poses late.txt --first-pose 7 --true-poses timed.csv");
    EXPECT_NE(late.out.find("poses: 2 tracked, 1 lost"), std::string::npos) << late.out;
    EXPECT_LT(number_behind(late.out, "position error (mm)", 2), 0.01);
    EXPECT_EQ(late.err.find("taken for"), std::string::npos) << late.err;
    EXPECT_GT(number_behind(run("ar run video.yaml --fast --poses late.txt --true-poses timed.csv").out,
                            "position error (mm)"),
              5)
        << "which stderr tells";
    EXPECT_EQ(run("ar run video.yaml --fast --poses timed.csv --first-pose 7").code, 2);
    EXPECT_EQ(run("ar run video.yaml --fast --poses all.txt --first-pose many").code, 2);
    EXPECT_EQ(run("ar run video.yaml --fast --first-pose 7").code, 2);
}

TEST_F(ArRuns, CountFramesThatAreNoFrames)
{
    fs::copy(desk() / "frames", desk() / "damaged");
    std::string const bytes = file_text(desk() / "damaged/000001.png");
    write(desk() / "damaged/000001.png", bytes.substr(0, bytes.size() / 2));
    std::string text = empty_session();
    text.replace(text.find("source: frames"), 14, "source: damaged");
    write(desk() / "damaged.yaml", text);
    Outcome const o = run("ar run damaged.yaml --fast --poses poses.csv");
    ASSERT_EQ(o.code, 0) << o.err;
    EXPECT_NE(o.out.find("2 frames, "), std::string::npos) << o.out;
    EXPECT_NE(o.out.find("1 refused"), std::string::npos) << o.out;
    // Two of three were found.
    Outcome const more = run("ar run damaged.yaml --fast --poses poses.csv --require-found 70%");
    EXPECT_EQ(more.code, 1);
    EXPECT_NE(more.err.find("found in 2 of 3 frames, 1 were refused (70 % are required)"), std::string::npos)
        << more.err;
    EXPECT_EQ(run("ar run damaged.yaml --fast --poses poses.csv --require-found 0.6").code, 0);
    EXPECT_EQ(run("ar run damaged.yaml --fast --poses poses.csv --require-found many").code, 2);
    write(desk() / "damaged/000002.png", "no picture");
    Outcome const most = run("ar run damaged.yaml --fast --poses poses.csv");
    EXPECT_EQ(most.code, 1);
    EXPECT_NE(most.err.find("2 of 3 frames were refused"), std::string::npos) << most.err;
    std::string estimated = file_text(desk() / "damaged.yaml");
    estimated.replace(estimated.find("near.glb"), 8, "near.glb, albedo: estimate");
    write(desk() / "estimated.yaml", estimated);
    Outcome const albedo = run("ar albedo estimated.yaml --poses poses.csv --views 1 --paths 1 --resolution 0.1");
    EXPECT_EQ(albedo.code, 1);
    EXPECT_NE(albedo.err.find("2 of 3 frames were refused"), std::string::npos) << albedo.err;
}

TEST_F(ArRuns, KeepResultAndInput)
{
    Outcome const o =
        run("ar run session.yaml --poses poses.csv --video run.mkv --record-input recorded --out out");
    ASSERT_EQ(o.code, 0) << o.err;
    EXPECT_NE(o.out.find("recorded: 3 frames; 0 lost"), std::string::npos) << o.out;
    EXPECT_TRUE(fs::exists(desk() / "run.mkv"));
    EXPECT_FALSE(fs::exists(desk() / ".run.unfinished.mkv"));
    // What was recorded is what was filmed: it runs again.
    std::string text = session();
    text.replace(text.find("source: frames"), 14, "source: recorded");
    write(desk() / "again.yaml", text);
    Outcome const again = run("ar run again.yaml --fast --poses poses.csv --video again.mkv --out again");
    ASSERT_EQ(again.code, 0) << again.err;
    EXPECT_NE(again.out.find("again.mkv: 3 pictures at 30 Hz, 0 of them repeated"), std::string::npos)
        << again.out;
    EXPECT_EQ(std::distance(fs::directory_iterator(desk() / "again"), {}), 3);

    Outcome const twice = run("ar run session.yaml --record-input recorded");
    EXPECT_EQ(twice.code, 2);
    EXPECT_NE(twice.err.find("recorded"), std::string::npos) << twice.err;
    EXPECT_EQ(run("ar run session.yaml --fast --video run.avi").code, 2);
    EXPECT_EQ(run("ar run session.yaml --fast --record-input other").code, 2);
}

TEST_F(ArRuns, RefuseACalibrationOfAnotherSize)
{
    std::string text = file_text(desk() / "camera.yaml");
    std::size_t const at = text.find("image_width: ");
    text.replace(at, text.find('\n', at) - at, "image_width: 320");
    write(desk() / "camera.yaml", text);
    Outcome const o = run("ar track session.yaml --fast");
    EXPECT_EQ(o.code, 2);
    EXPECT_NE(o.err.find("320 x 120"), std::string::npos) << o.err;
}

TEST_F(ArRuns, SayWhatIsWrongWithTheirFiles)
{
    auto const refused = [this](std::string const& command, std::string const& with) {
        Outcome const o = run(command);
        EXPECT_EQ(o.code, 2) << command;
        EXPECT_NE(o.err.find(with), std::string::npos) << o.err;
        EXPECT_EQ(std::count(o.err.begin(), o.err.end(), '\n'), 1) << o.err;
    };
    refused("ar run nowhere.yaml", "nowhere.yaml");
    write(desk() / "key.yaml", session() + "colour: 3\n");
    refused("ar run key.yaml", "key.yaml:");
    refused("ar run session.yaml --poses missing.csv", "missing.csv");
    refused("ar run session.yaml --truth missing", "missing");
    refused("ar synthesize . --frames 7 --size 240x180", "holds another session");
    refused("ar run session.yaml --out frames", "a folder that is read");
    refused("ar run session.yaml --out truth --truth truth", "a folder that is read");
    refused("ar run session.yaml --table camera.yaml", "camera.yaml");
    fs::create_directory(desk() / "mattes");
    fs::create_directory(desk() / "depths");
    fs::copy(desk() / "frames/000000.png", desk() / "mattes/000000.png");
    write(desk() / "occluded.yaml", session() + "occlusion: {matte: mattes, depth: depths/%06d.png}\n");
    refused("ar run occluded.yaml --out mattes", "a folder that is read");
    refused("ar run occluded.yaml --out depths", "a folder that is read");
    refused("ar run occluded.yaml --passes mattes", "has other pictures");
}

} // namespace
} // namespace viewer::test
