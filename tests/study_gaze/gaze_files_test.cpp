// Eye tracking in BIDS as input.

#include "gi/core/error.h"
#include "gi/core/file.h"
#include "gi/core/gzip.h"
#include "study/gaze/gaze_analysis.h"
#include "study/gaze/gaze_tables.h"
#include "tests/study_gaze/simulated_gaze.h"
#include "tests/study_stats/support/study_data.h"

#include <fmt/format.h>
#include <fstream>
#include <unistd.h>

namespace study::test {
namespace {

namespace fs = std::filesystem;

/// A data set of one recording of two eyes at 500 Hz, on kGazeScreen; a trial of 20 s in its middle.
class BidsGaze : public testing::Test {
protected:
    BidsGaze()
    {
        fs::create_directories(folder());
        write(root_ / "dataset_description.json", R"({"Name": "made", "BIDSVersion": "1.11.1"})");
        write(root_ / "task-view_physio.json",
              R"({"SamplingFrequency": 500, "StartTime": -2, "SampleCoordinateSystem": "gaze-on-screen",
                  "Columns": ["timestamp", "x_coordinate", "y_coordinate", "pupil_size"],
                  "timestamp": {"Units": "ms"}, "x_coordinate": {"Units": "pixel"}})");
        write(root_ / "task-view_events.json",
              R"({"StimulusPresentation": {"ScreenDistance": 0.573, "ScreenOrigin": ["top", "left"],
                  "ScreenResolution": [1920, 1080], "ScreenSize": [0.531, 0.2987]}})");
        write(folder() / "sub-01_task-view_events.tsv",
              "onset\tduration\ttrial_type\n10\t20\tpicture\n30\tn/a\tcue\n");
        for (int eye = 1; eye <= 2; ++eye) {
            write_eye(eye);
            write(folder() / stem(eye).append(".json"),
                  fmt::format(R"({{"RecordedEye": "{}"}})", eye == 1 ? "left" : "right"));
        }
    }
    ~BidsGaze() override { fs::remove_all(root_); }

    fs::path folder() const { return root_ / "sub-01" / "beh"; }
    static std::string stem(int eye) { return fmt::format("sub-01_task-view_recording-eye{}_physio", eye); }
    fs::path eye_file(int eye) const { return folder() / (stem(eye) + ".tsv.gz"); }
    static void write(fs::path const& file, std::string const& text)
    {
        std::ofstream(file, std::ios::binary) << text;
    }
    /// The eyes differ by 1 degree.
    void write_eye(int eye)
    {
        std::string rows;
        for (std::size_t i = 0; i < gaze_.samples.size(); ++i) {
            GazeSample const& s = gaze_.samples[i];
            double const x = s.x_px + (eye == 1 ? -18 : 18) + 960, y = s.y_px + 540;
            if (s.is_valid)
                rows += fmt::format("{}\t{:.3f}\t{:.3f}\t4.1\n", 700000 + 2 * i, x, y);
            else
                rows += fmt::format("{}\tn/a\tn/a\tn/a\n", 700000 + 2 * i);
        }
        write(eye_file(eye), gi::gzip(rows));
    }
    std::string error_of(std::vector<fs::path> const& files) const
    {
        try {
            gaze_of_files(files, {}, GazeEyes::mean);
        } catch (gi::InputError const& e) {
            return e.what();
        }
        return {};
    }

    fs::path root_ = fs::temp_directory_path() / fmt::format("lightwell_bids_gaze_{}", getpid());
    SimulatedGaze gaze_ = simulated_gaze({});
};

TEST_F(BidsGaze, OfTwoEyesIsTheirMean)
{
    GazeRecordings const all = gaze_of_files({eye_file(1), eye_file(2)}, {}, GazeEyes::mean);
    ASSERT_EQ(all.recordings.size(), 1u);
    GazeRecording const& r = all.recordings[0];
    EXPECT_EQ(r.name, "sub-01_task-view");
    EXPECT_EQ(r.participant, "01");
    EXPECT_EQ(r.eyes, "mean of left and right");
    EXPECT_EQ(r.screen.width_px, 1920);
    EXPECT_NEAR(r.screen.distance_cm, 57.3, 1e-9);
    ASSERT_EQ(r.samples.size(), gaze_.samples.size());
    EXPECT_EQ(r.counts.samples, 2 * int(gaze_.samples.size()));
    EXPECT_NEAR(r.samples[0].time_s, -2, 1e-9) << "StartTime";
    EXPECT_NEAR(r.samples[100].x_px, gaze_.samples[100].x_px, 2e-3);
    ASSERT_EQ(r.views.size(), 1u) << "the cue has no duration";
    EXPECT_EQ(r.views[0].condition, "picture");
    EXPECT_EQ(all.remarks.size(), 1u);
    EXPECT_EQ(all.inputs.size(), 2u);

    GazeRecordings const left = gaze_of_files({eye_file(1), eye_file(2)}, {}, GazeEyes::left);
    EXPECT_NEAR(left.recordings[0].samples[100].x_px, gaze_.samples[100].x_px - 18, 2e-3);

    GazeAnalysis const a = analyse_gaze(gaze_of_files({eye_file(1), eye_file(2)}, {}, GazeEyes::mean), {});
    ViewedGaze const& v = a.recordings.at(0)->views.at(0);
    int expected = 0;
    for (auto const& f : gaze_.fixations) expected += f.end_s - 2 > 10 && f.start_s - 2 < 30;
    EXPECT_NEAR(int(v.fixations.size()), expected, 2);
    EXPECT_TRUE(v.is_usable);
    fmt::print("main sequence: slope {:.3f} +- {:.3f}, {:.1f} deg/s at 1 degree; {:.2f} ms/deg (2.2 simulated)\n",
               a.recordings[0]->sequence.slope, a.recordings[0]->sequence.slope_se,
               a.recordings[0]->sequence.at_one_deg, a.recordings[0]->sequence.ms_per_deg);
    EXPECT_NEAR(a.recordings[0]->sequence.ms_per_deg, 2.2, 0.5);
}

TEST_F(BidsGaze, RowsWithOtherCellsAreCounted)
{
    write(eye_file(1), gi::gzip("0\t960\t540\t4\n2\t960\n4\t960\t540\t4\t5\n6\t960\t540\tn/a\n8\t960\t540\t\n"));
    GazeRecording const r = gaze_of_files({eye_file(1)}, {}, GazeEyes::mean).recordings.at(0);
    EXPECT_EQ(r.counts.samples, 5);
    EXPECT_EQ(r.counts.unreadable, 2);
    EXPECT_EQ(r.samples.size(), 3u);
}

TEST_F(BidsGaze, BecomesADerivativeDataSet)
{
    GazeAnalysis const a = analyse_gaze(gaze_of_files({eye_file(1), eye_file(2)}, {}, GazeEyes::mean), {});
    auto const files = gaze_derivatives(a, "1.0");
    ASSERT_EQ(files.size(), 3u);
    EXPECT_EQ(files[1].path, "sub-01/beh/sub-01_task-view_desc-gaze_physioevents.tsv.gz");
    std::string const text = gi::gunzip(files[1].text, "made");
    auto const lines = std::size_t(std::count(text.begin(), text.end(), '\n'));
    GazeEvents const& e = a.recordings[0]->events;
    EXPECT_EQ(lines, e.fixations.size() + e.saccades.size() + e.losses.size());
    auto const json = nlohmann::json::parse(files[2].text);
    EXPECT_EQ(json["Columns"].size(),
              std::size_t(std::count(text.begin(), text.begin() + long(text.find('\n')), '\t')) + 1);
    for (auto const& column : json["Columns"]) EXPECT_TRUE(json.contains(column)) << column;
}

TEST_F(BidsGaze, IsRefusedWithOneReason)
{
    auto const expect = [&](std::vector<fs::path> const& files, std::string const& part) {
        std::string const message = error_of(files);
        EXPECT_NE(message.find(part), std::string::npos) << message;
    };
    expect({eye_file(1), eye_file(1)}, "given twice");
    expect({root_}, "is a folder");
    expect({folder() / "sub-02_physio.tsv.gz"}, "sub-02_physio.tsv.gz");
    write(eye_file(1), "no gzip");
    expect({eye_file(1)}, "cannot be unpacked");
    std::string const packed = gi::gzip("1\t2\t3\t4\n");
    write(eye_file(1), packed.substr(0, packed.size() - 9));
    expect({eye_file(1)}, "cut off");
    write(eye_file(1), gi::gzip("1\t2\t3\t4\n2\tx\t3\t4\n"));
    expect({eye_file(1)}, ".tsv.gz:2:3: 'x' is no number");
    write(eye_file(1), gi::gzip(""));
    expect({eye_file(1)}, "has no samples");
    write_eye(1);
    write(root_ / "task-view_physio.json", R"({"Columns": ["timestamp", "x_coordinate"]})");
    expect({eye_file(1)}, "no columns x_coordinate and y_coordinate");
    write(root_ / "task-view_physio.json", R"({"Columns": ["x_coordinate", "y_coordinate"], "StartTime": "n/a"})");
    expect({eye_file(1)}, "wrong type");
    write(root_ / "task-view_physio.json", R"({"Columns": ["x_coordinate", "y_coordinate"]})");
    expect({eye_file(1)}, "neither timestamp nor SamplingFrequency");
    fs::remove(root_ / "task-view_physio.json");
    expect({eye_file(1)}, "no Columns");
    fs::remove(root_ / "task-view_events.json");
    write(root_ / "task-view_physio.json", R"({"Columns": ["timestamp", "x_coordinate", "y_coordinate"]})");
    expect({eye_file(1)}, "ScreenDistance is missing");
}

TEST(BidsGazeOfOthers, OfTwoEyesIsRead)
{
    LIGHTWELL_NEED_STUDY_DATA();
    fs::path const beh = study_data() / "bids_eyetracking/sub-01/beh";
    std::string const stem = "sub-01_task-FreeView_run-01_recording-eye";
    std::vector<fs::path> const files{beh / (stem + "1_physio.tsv.gz"), beh / (stem + "2_physio.tsv.gz")};
    if (!fs::exists(files[0])) GTEST_SKIP() << "SKIPPED: no recording at " << files[0];
    if (gi::gunzip(gi::read_text(files[0]), "physio").empty()) {
        EXPECT_THROW(gaze_of_files(files, kGazeScreen, GazeEyes::mean), gi::InputError);
        GTEST_SKIP() << "SKIPPED: the data set has no samples, only names and descriptions: " << files[0];
    }
    GazeRecordings const all = gaze_of_files(files, kGazeScreen, GazeEyes::mean);
    EXPECT_EQ(all.recordings.size(), 1u);
}

} // namespace
} // namespace study::test
